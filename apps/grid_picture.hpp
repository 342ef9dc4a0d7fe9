// An occupancy grid as a drawing.
#pragma once

#include <string>

#include "helicoid/charts/occupancy_grid.hpp"

namespace helicoid {

/// An SVG of one pixel a cell: occupied dark, free light, the rest between.
[[nodiscard]] std::string draw_grid(const OccupancyGrid& grid);

}  // namespace helicoid
