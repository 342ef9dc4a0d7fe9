// A square of an island's plane as the patches of one sheet know it: free, obstacle, or unknown. 10 cm cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/exploration/patch_view.hpp"
#include "helicoid/geometry/row_spans.hpp"
#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// A cell of an island's plane: its centre is ((column + 0.5) kGroundCell, (row + 0.5) kGroundCell).
struct GroundCell {
  std::int32_t row = 0;
  std::int32_t column = 0;
  friend auto operator<=>(const GroundCell&, const GroundCell&) = default;
};
constexpr double kGroundCell = 0.10;  // metres
[[nodiscard]] GroundCell ground_cell(const Vector2d& p_plane);
[[nodiscard]] Vector2d centre_of(const GroundCell& cell);

/// The cells of one patch, where it lies now.
struct PatchCells {
  Pose2 T_plane_patch;  ///< where the patch lay when they were found
  std::vector<RowSpan> free;
  std::vector<GroundCell> obstacles;
  GroundCell low, high;  ///< the rectangle about them
};
[[nodiscard]] PatchCells find_cells(const PatchView& view, const Pose2& T_plane_patch, double body);

/// Kept from one call to the next; a patch's cells are found anew when it has moved.
class PatchCellTable {
 public:
  const PatchCells& of(const PatchView& view, const Pose2& T_plane_patch);

 private:
  struct Known {
    const Patch* patch = nullptr;
    PatchCells cells;
  };
  std::vector<Known> known_;  ///< by patch
};

class GroundWindow {
 public:
  /// Of (2 half_width + 1) cells' width about the middle.
  GroundWindow(const GroundCell& middle, int half_width);
  void add(const PatchCells& cells);
  /// After the last patch: what is within `reach` cells of an obstacle is `near` one.
  void mark_near_obstacles(int reach);

  [[nodiscard]] bool holds(const GroundCell& c) const {
    return c.row >= low_.row && c.column >= low_.column && c.row < low_.row + width_ && c.column < low_.column + width_;
  }
  [[nodiscard]] bool is_free(const GroundCell& c) const { return (at(c) & kFree) != 0; }
  [[nodiscard]] bool is_obstacle(const GroundCell& c) const { return (at(c) & kObstacle) != 0; }
  [[nodiscard]] bool is_near_obstacle(const GroundCell& c) const { return (at(c) & kNear) != 0; }
  [[nodiscard]] bool is_unknown(const GroundCell& c) const { return (at(c) & (kFree | kObstacle)) == 0; }
  /// True if a disc of this radius, in cells, lies on free floor only.
  [[nodiscard]] bool has_room(const GroundCell& c, double radius) const;
  /// Numbers cells 0..cells()-1, row by row.
  [[nodiscard]] std::size_t index(const GroundCell& c) const {
    return static_cast<std::size_t>(c.row - low_.row) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(c.column - low_.column);
  }
  [[nodiscard]] std::size_t cells() const { return flags_.size(); }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] const GroundCell& low() const { return low_; }

 private:
  static constexpr std::uint8_t kFree = 1, kObstacle = 2, kNear = 4;
  [[nodiscard]] std::uint8_t at(const GroundCell& c) const { return holds(c) ? flags_[index(c)] : std::uint8_t{0}; }

  GroundCell low_;
  int width_;
  std::vector<std::uint8_t> flags_;
};

}  // namespace helicoid
