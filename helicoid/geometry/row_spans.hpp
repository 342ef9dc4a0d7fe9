// A polygon on a raster, row by row: the fast approximate stand-in for a polysolid. Its cost follows the outline and
// not the area.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// Cells of one row in a run: columns first..last, both included. Cell (c, r) has its centre at
/// ((c + 0.5) cell, (r + 0.5) cell).
struct RowSpan {
  std::int32_t row = 0;
  std::int32_t first = 0;
  std::int32_t last = 0;
  friend bool operator==(const RowSpan&, const RowSpan&) = default;
};

/// Turns polygons into row spans; keeps its buffer, so that no polygon allocates once it has grown.
class RowScanner {
 public:
  /// Calls `visit(RowSpan)` for the cells (`cell` metres wide) whose centres lie inside an open ring by the even-odd
  /// rule, ordered by row and column. `T_plane_ring` takes the ring's coordinates to the raster's.
  template <class Visit>
  void scan(std::span<const Eigen::Vector2f> ring, const Pose2& T_plane_ring, double cell, Visit&& visit) {
    find_crossings(ring, T_plane_ring, cell);
    // Between an odd and an even crossing of a row lies the inside.
    for (std::size_t k = 0; k + 1 < crossings_.size(); k += 2) {
      const auto first = static_cast<std::int32_t>(std::ceil(crossings_[k].column));
      const auto last = static_cast<std::int32_t>(std::ceil(crossings_[k + 1].column)) - 1;
      if (first <= last) visit(RowSpan{crossings_[k].row, first, last});
    }
  }

 private:
  struct Crossing {
    std::int32_t row;
    float column;
  };
  void find_crossings(std::span<const Eigen::Vector2f> ring, const Pose2& T_plane_ring, double cell);

  std::vector<Crossing> crossings_;  ///< of the ring's edges with the rows' centre lines
};

/// The spans of one polygon.
[[nodiscard]] std::vector<RowSpan> row_spans(std::span<const Eigen::Vector2f> ring, const Pose2& T_plane_ring,
                                             double cell);

/// How many cells two polygons share; both lists as row_spans gives them, of one raster.
[[nodiscard]] std::int64_t shared_cells(std::span<const RowSpan> a, std::span<const RowSpan> b);
/// How many cells a polygon covers.
[[nodiscard]] std::int64_t count_cells(std::span<const RowSpan> spans);

}  // namespace helicoid
