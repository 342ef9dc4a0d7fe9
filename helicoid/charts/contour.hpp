// Contours of a raster's free cells.
#pragma once

#include <vector>

#include "helicoid/charts/occupancy_grid.hpp"

namespace helicoid::charts {

/// A closed contour through the middles of the edges between free cells and others, free on the left.
struct Contour {
  struct Step {
    int x2 = 0, y2 = 0;  ///< the middle of an edge in half cells from the grid's origin
    bool wall = false;   ///< an occupied cell lies within two cells beyond
  };
  std::vector<Step> steps;
};

/// All contours, in the order in which rows are read.
[[nodiscard]] std::vector<Contour> trace_contours(const GridFrame& frame, const std::vector<CellState>& states);

/// Positive if anticlockwise; in cells.
[[nodiscard]] double signed_area(const Contour& contour);

}  // namespace helicoid::charts
