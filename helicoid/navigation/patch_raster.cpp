#include "helicoid/navigation/patch_raster.hpp"

#include <algorithm>

#include "helicoid/geometry/row_spans.hpp"

namespace helicoid {

namespace {

/// A point this deep in free space is no edge of it, metres.
constexpr double kDepth = 0.30;
/// Where beams lie closer than this they overlook nothing that stops a robot, metres.
constexpr double kBeamSpacing = 0.05;

/// A raster is made anew when what it shows has moved this far, metres.
constexpr double kTolerance = 0.01;
/// The same of a bystander, metres.
constexpr double kBystanderMoved = 0.05;
/// No part of a robot is farther from its centre, as the map has that; metres.
constexpr double kBody = 0.40;

/// The star of the patch's free space without its rim and without what lies far from the laser; patch frame.
std::vector<Eigen::Vector2f> surely_free_ring(const Patch& patch) {
  std::vector<Eigen::Vector2f> ring{patch.scan.T_robot_laser.translation().cast<float>()};
  const double farthest = kBeamSpacing / patch.laser.bearing_step;
  for (std::size_t i = 0; i < patch.free_ranges.size(); ++i) {
    const double range = std::min(static_cast<double>(patch.free_ranges[i]) - kDepth, farthest);
    const double bearing = patch.laser.bearing(static_cast<int>(i));
    const Vector2d p_laser = std::max(range, 0.0) * Vector2d(std::cos(bearing), std::sin(bearing));
    ring.push_back((patch.scan.T_robot_laser * p_laser).cast<float>());
  }
  return ring;
}

/// The parts by block, made when they are first asked for.
class Parts {
 public:
  /// `reach` metres about the patch at most.
  Parts(const Vector2d& centre, double reach)
      : first_{first_block_about(cell_of(centre.x() - reach) - 1), first_block_about(cell_of(centre.y() - reach) - 1)},
        columns_(last_block_about(cell_of(centre.x() + reach) + 1) - first_.column + 1),
        rows_(last_block_about(cell_of(centre.y() + reach) + 1) - first_.row + 1),
        place_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1) {}

  PatchRaster::Part* find(std::int32_t column, std::int32_t row) {
    if (column < first_.column || row < first_.row) return nullptr;
    if (column >= first_.column + columns_ || row >= first_.row + rows_) return nullptr;
    const int at = place_[index(column, row)];
    return at < 0 ? nullptr : &parts_[static_cast<std::size_t>(at)];
  }
  PatchRaster::Part& get(std::int32_t column, std::int32_t row) {
    int& at = place_[index(column, row)];
    if (at < 0) {
      at = static_cast<int>(parts_.size());
      parts_.emplace_back().block = {column, row};
    }
    return parts_[static_cast<std::size_t>(at)];
  }
  std::vector<PatchRaster::Part> take() {
    std::sort(parts_.begin(), parts_.end(), [](const auto& a, const auto& b) { return a.block < b.block; });
    return std::move(parts_);
  }

 private:
  [[nodiscard]] std::size_t index(std::int32_t column, std::int32_t row) const {
    return static_cast<std::size_t>(row - first_.row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column - first_.column);
  }
  FloorBlock first_;
  std::int32_t columns_, rows_;
  std::vector<int> place_;
  std::vector<PatchRaster::Part> parts_;
};

/// Bits first..last of a word; both may lie beyond its ends.
std::uint64_t bits_between(std::int32_t first, std::int32_t last) {
  first = std::max(first, 0);
  last = std::min(last, 63);
  if (first > last) return 0;
  return (~std::uint64_t{0} >> (63 - (last - first))) << first;
}

/// Calls f(column, row, cell row in the tile, bits) for each block that knows cells of the span.
template <class F>
void for_each_block(const RowSpan& span, F&& f) {
  for (std::int32_t row = first_block_about(span.row); row <= last_block_about(span.row); ++row) {
    const std::int32_t tile_row = span.row - row * kBlockCells + kHaloCells;
    for (std::int32_t column = first_block_about(span.first); column <= last_block_about(span.last); ++column) {
      const std::int32_t offset = column * kBlockCells - kHaloCells;
      f(column, row, static_cast<std::size_t>(tile_row), bits_between(span.first - offset, span.last - offset));
    }
  }
}

void add_obstacles(const Patch& patch, const Pose2& T_plane_patch, std::span<const Vector2d> bystanders, Parts& parts) {
  for (std::size_t i = 0; i < patch.points.size(); ++i) {
    const Vector2d p_patch(patch.points.x[i], patch.points.y[i]);
    const auto returned = [&](const Vector2d& stand) { return (p_patch - stand).norm() < kBody; };
    if (std::any_of(bystanders.begin(), bystanders.end(), returned)) continue;
    const Vector2d p = T_plane_patch * p_patch;
    const std::int32_t column = cell_of(p.x());
    const std::int32_t row = cell_of(p.y());
    for (std::int32_t r = first_block_about(row); r <= last_block_about(row); ++r) {
      for (std::int32_t c = first_block_about(column); c <= last_block_about(column); ++c) {
        PatchRaster::Part* part = parts.find(c, r);
        if (part != nullptr) part->obstacles.emplace_back((p - part->block.halo_corner()).cast<float>());
      }
    }
  }
}

}  // namespace

const PatchRaster::Part* PatchRaster::part(const FloorBlock& block) const {
  const auto at = std::lower_bound(parts.begin(), parts.end(), block,
                                   [](const Part& part, const FloorBlock& wanted) { return part.block < wanted; });
  return at != parts.end() && at->block == block ? &*at : nullptr;
}

bool PatchRaster::holds(const Patch& patch, const Pose2& T_plane_patch_now,
                        std::span<const Vector2d> bystanders_now) const {
  if (patch.robot != robot || patch.scan_index != scan_index) return false;
  const auto is_same = [](const Vector2d& a, const Vector2d& b) { return (a - b).norm() <= kBystanderMoved; };
  if (!std::equal(bystanders.begin(), bystanders.end(), bystanders_now.begin(), bystanders_now.end(), is_same)) {
    return false;
  }
  const double moved = (T_plane_patch_now.translation() - T_plane_patch.translation()).norm();
  const double turned = std::abs(wrap_angle(T_plane_patch_now.yaw - T_plane_patch.yaw));
  return moved + turned * patch.reach <= kTolerance;
}

PatchRaster make_patch_raster(const Patch& patch, const Pose2& T_plane_patch, std::vector<Vector2d> bystanders) {
  Parts parts(T_plane_patch.translation(), patch.free_reach);
  RowScanner scanner;
  scanner.scan(patch.free_space, T_plane_patch, kFloorCell, [&](const RowSpan& span) {
    for_each_block(span, [&](std::int32_t column, std::int32_t row, std::size_t tile_row, std::uint64_t bits) {
      if (bits != 0) parts.get(column, row).free[tile_row] |= bits;
    });
  });
  scanner.scan(surely_free_ring(patch), T_plane_patch, kFloorCell, [&](const RowSpan& span) {
    for_each_block(span, [&](std::int32_t column, std::int32_t row, std::size_t tile_row, std::uint64_t bits) {
      PatchRaster::Part* part = parts.find(column, row);
      if (part != nullptr) part->surely_free[tile_row] |= bits;
    });
  });
  add_obstacles(patch, T_plane_patch, bystanders, parts);
  return {patch.robot, patch.scan_index, T_plane_patch, std::move(bystanders), parts.take()};
}

}  // namespace helicoid
