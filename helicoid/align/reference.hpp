// What a scan is aligned to: the surfaces of a few patches, fused into one table of small surface elements.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/align/nearest_on_side.hpp"
#include "helicoid/geometry/pose2.hpp"
#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

/// One patch's points and where the patch stands relative to the reference's frame.
struct ReferencePart {
  const ScanPoints* points = nullptr;
  Pose2 T_reference_patch;
};

/// A piece of surface: the weighted mean of the points that fell on it, with the normal of the side it was seen from.
struct SurfaceElement {
  float x, y;    ///< metres, reference frame
  float nx, ny;  ///< unit normal, towards the observers
  float weight;  ///< sum of the points' weights
  float facing;  ///< weighted mean of the points' (ScanPoints::facing)
};

/// Surface elements in a grid, row by row, so that a search reads a few contiguous runs. Rebuilt when the robot has
/// moved on; its buffers are kept, so that no rebuild allocates once they have grown.
class Reference {
 public:
  void build(std::span<const ReferencePart> parts);
  [[nodiscard]] std::size_t size() const { return x_.size(); }
  [[nodiscard]] bool empty() const { return x_.empty(); }
  [[nodiscard]] SurfaceElement element(std::size_t i) const {
    return {x_[i], y_[i], nx_[i], ny_[i], weight_[i], facing_[i]};
  }
  [[nodiscard]] OrientedPoints points() const {
    return {x_.data(), y_.data(), nx_.data(), ny_.data(), static_cast<int>(x_.size())};
  }

  /// The element nearest to p within `gate` metres whose normal agrees (cosine above kSameSide); -1: none.
  [[nodiscard, gnu::always_inline]] int nearest(const OrientedPoint& p, float gate) const {
    constexpr float kPerCell = 1 / kCell;
    const float at_x = (p.x - origin_x_) * kPerCell;
    const float at_y = (p.y - origin_y_) * kPerCell;
    const float reach = gate * kPerCell;
    if (!(at_x + reach >= 0 && at_y + reach >= 0 && at_x - reach < static_cast<float>(columns_) &&
          at_y - reach < static_cast<float>(rows_))) {
      return -1;
    }
    const int first_column = std::max(0, static_cast<int>(at_x - reach));
    const int last_column = std::min(columns_ - 1, static_cast<int>(at_x + reach));
    const int first_row = std::max(0, static_cast<int>(at_y - reach));
    const int last_row = std::min(rows_ - 1, static_cast<int>(at_y + reach));
    NearestOnSide search(p, gate);
    const std::uint32_t* start = start_.data() + static_cast<std::ptrdiff_t>(first_row) * columns_;
    for (int row = first_row; row <= last_row; ++row, start += columns_) {
      search.look(points(), static_cast<int>(start[first_column]), static_cast<int>(start[last_column + 1]));
    }
    return search.found();
  }

  static constexpr float kCell = 0.25F;

 private:
  void gather(std::span<const ReferencePart> parts);
  void frame();
  void fuse();
  void sort_by_cell();

  std::vector<SurfaceElement> points_;                    ///< transformed, not yet fused
  std::vector<SurfaceElement> fused_;                     ///< sums, in order of making
  std::vector<std::uint32_t> cell_of_;                    ///< by fused element
  std::vector<std::int32_t> next_;                        ///< linked list within a cell while fusing
  std::vector<std::int32_t> head_;                        ///< by cell
  std::vector<std::uint32_t> start_;                      ///< by cell: the first of its elements; one more than cells
  std::vector<float> x_, y_, nx_, ny_, weight_, facing_;  ///< the elements, ordered by cell
  float origin_x_ = 0, origin_y_ = 0;
  int columns_ = 0, rows_ = 0;
};

}  // namespace helicoid
