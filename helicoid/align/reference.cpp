#include "helicoid/align/reference.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// Points closer than this, of one side, are the same piece of surface.
constexpr float kFuseRadius = 0.06F;
/// A table is never larger than this; points beyond are left out (a 150 m wide reference).
constexpr int kMaxSide = 600;

}  // namespace

void Reference::build(std::span<const ReferencePart> parts) {
  gather(parts);
  for (std::vector<float>* list : {&x_, &y_, &nx_, &ny_, &weight_, &facing_}) list->clear();
  if (points_.empty()) return;
  frame();
  fuse();
  sort_by_cell();
}

void Reference::gather(std::span<const ReferencePart> parts) {
  points_.clear();
  for (const ReferencePart& part : parts) {
    const auto c = static_cast<float>(std::cos(part.T_reference_patch.yaw));
    const auto s = static_cast<float>(std::sin(part.T_reference_patch.yaw));
    const auto tx = static_cast<float>(part.T_reference_patch.x);
    const auto ty = static_cast<float>(part.T_reference_patch.y);
    const ScanPoints& p = *part.points;
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (p.weight[i] <= 0) continue;
      points_.push_back({tx + c * p.x[i] - s * p.y[i], ty + s * p.x[i] + c * p.y[i], c * p.nx[i] - s * p.ny[i],
                         s * p.nx[i] + c * p.ny[i], p.weight[i], p.facing[i]});
    }
  }
}

void Reference::frame() {
  float low_x = points_.front().x;
  float low_y = points_.front().y;
  float high_x = low_x;
  float high_y = low_y;
  for (const SurfaceElement& p : points_) {
    low_x = std::min(low_x, p.x);
    low_y = std::min(low_y, p.y);
    high_x = std::max(high_x, p.x);
    high_y = std::max(high_y, p.y);
  }
  const float widest = kMaxSide * kCell;
  origin_x_ = std::max(low_x, 0.5F * (low_x + high_x - widest)) - kCell;
  origin_y_ = std::max(low_y, 0.5F * (low_y + high_y - widest)) - kCell;
  columns_ = std::min(kMaxSide, static_cast<int>((high_x - origin_x_) / kCell)) + 2;
  rows_ = std::min(kMaxSide, static_cast<int>((high_y - origin_y_) / kCell)) + 2;
}

void Reference::fuse() {
  fused_.clear();
  cell_of_.clear();
  next_.clear();
  head_.assign(static_cast<std::size_t>(columns_) * rows_, -1);
  for (const SurfaceElement& p : points_) {
    const int column = static_cast<int>((p.x - origin_x_) / kCell);
    const int row = static_cast<int>((p.y - origin_y_) / kCell);
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
    const auto cell = static_cast<std::size_t>(row) * columns_ + column;
    std::int32_t at = head_[cell];
    for (; at >= 0; at = next_[at]) {
      // The sums of a fused element are kept undivided until the end.
      const SurfaceElement& e = fused_[at];
      const float scale = 1 / e.weight;
      const float dx = e.x * scale - p.x;
      const float dy = e.y * scale - p.y;
      const float agreement = (e.nx * p.nx + e.ny * p.ny) * scale;
      if (dx * dx + dy * dy < kFuseRadius * kFuseRadius && agreement > kSameSide) break;
    }
    if (at >= 0) {
      SurfaceElement& e = fused_[at];
      e.x += p.weight * p.x;
      e.y += p.weight * p.y;
      e.nx += p.weight * p.nx;
      e.ny += p.weight * p.ny;
      e.weight += p.weight;
      e.facing += p.weight * p.facing;
    } else {
      next_.push_back(head_[cell]);
      head_[cell] = static_cast<std::int32_t>(fused_.size());
      cell_of_.push_back(static_cast<std::uint32_t>(cell));
      fused_.push_back(
          {p.weight * p.x, p.weight * p.y, p.weight * p.nx, p.weight * p.ny, p.weight, p.weight * p.facing});
    }
  }
}

void Reference::sort_by_cell() {
  start_.assign(head_.size() + 1, 0);
  for (const std::uint32_t cell : cell_of_) ++start_[cell + 1];
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  for (std::vector<float>* list : {&x_, &y_, &nx_, &ny_, &weight_, &facing_}) list->resize(fused_.size());
  // head_ is free again: it now counts what each cell has received.
  std::fill(head_.begin(), head_.end(), 0);
  for (std::size_t i = 0; i < fused_.size(); ++i) {
    const SurfaceElement& e = fused_[i];
    const float scale = 1 / e.weight;
    const float length = std::sqrt(e.nx * e.nx + e.ny * e.ny);
    const std::size_t at = start_[cell_of_[i]] + static_cast<std::size_t>(head_[cell_of_[i]]++);
    x_[at] = e.x * scale;
    y_[at] = e.y * scale;
    nx_[at] = e.nx / length;
    ny_[at] = e.ny / length;
    weight_[at] = e.weight;
    facing_[at] = e.facing * scale;
  }
}

}  // namespace helicoid
