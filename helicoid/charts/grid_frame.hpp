// Where a raster lies in an island's plane.
#pragma once

#include <cstddef>
#include <span>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// A raster of square cells. Cell (column, row) covers [origin + (column, row) * resolution, + resolution); row 0 is
/// the lowest in y. Cells are stored row by row.
struct GridFrame {
  Vector2d origin = Vector2d::Zero();  ///< the lower left corner, in the island's plane; metres
  double resolution = 0.05;            ///< metres
  int width = 0;
  int height = 0;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool inside(int column, int row) const {
    return column >= 0 && row >= 0 && column < width && row < height;
  }
  [[nodiscard]] Vector2d centre(int column, int row) const {
    return origin + resolution * Vector2d(column + 0.5, row + 0.5);
  }
  /// Plane coordinates in cells: its whole parts are the column and the row.
  [[nodiscard]] Vector2d to_cells(const Vector2d& p_plane) const { return (p_plane - origin) / resolution; }
  friend bool operator==(const GridFrame&, const GridFrame&) = default;
};

struct GridFrameOptions {
  double resolution = 0.05;               ///< metres; doubled until the raster fits into largest_size
  double margin = 0.5;                    ///< around everything that the patches saw, metres
  std::size_t largest_size = 64'000'000;  ///< cells
};
/// The frame that holds all that these patches saw; its origin is a whole number of cells from the plane's. Without
/// patches it has one cell.
[[nodiscard]] GridFrame frame_around(const Map& map, std::span<const PatchId> patches,
                                     const GridFrameOptions& options = {});

}  // namespace helicoid
