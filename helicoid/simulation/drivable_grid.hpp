// The floor of a world on which a robot's centre can stand, as a raster.
#pragma once

#include <cstdint>
#include <vector>

#include "helicoid/simulation/world.hpp"

namespace helicoid {

/// Square cells, row by row; a cell is drivable if its centre keeps clear of all walls and a robot can get there.
struct DrivableGrid {
  Vector2d origin = Vector2d::Zero();  ///< the corner of the first cell, metres
  double cell = 0.1;                   ///< metres
  int width = 0, height = 0;
  std::vector<float> clearance;  ///< to the nearest wall, metres; 0 where a robot cannot be

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool drivable(int column, int row) const {
    return column >= 0 && row >= 0 && column < width && row < height && clearance[index(column, row)] > 0;
  }
  [[nodiscard]] Vector2d centre(std::size_t cell_index) const {
    const std::size_t column = cell_index % static_cast<std::size_t>(width);
    const std::size_t row = cell_index / static_cast<std::size_t>(width);
    return origin + cell * Vector2d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  }
};

/// What can be reached from the world's first start with this clearance (up to `farthest` it is measured); without a
/// start, the largest closed space. No cell is drivable if there is no room. Error: more than `most_cells`.
[[nodiscard]] Result<DrivableGrid> make_drivable_grid(const World& world, double cell, double clearance,
                                                      double farthest, std::size_t most_cells);

}  // namespace helicoid
