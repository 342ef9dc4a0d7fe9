#include "helicoid/geometry/row_spans.hpp"

#include <algorithm>

namespace helicoid {

void RowScanner::find_crossings(std::span<const Eigen::Vector2f> ring, const Pose2& T_plane_ring, double cell) {
  crossings_.clear();
  if (ring.empty()) return;
  const double per_cell = 1 / cell;
  const double c = std::cos(T_plane_ring.yaw);
  const double s = std::sin(T_plane_ring.yaw);
  const auto to_cells = [&](const Eigen::Vector2f& p) {
    const double x = p.x();
    const double y = p.y();
    return Vector2d((T_plane_ring.x + c * x - s * y) * per_cell - 0.5,
                    (T_plane_ring.y + s * x + c * y) * per_cell - 0.5);
  };
  Vector2d from = to_cells(ring.back());
  for (const Eigen::Vector2f& vertex : ring) {
    const Vector2d to = to_cells(vertex);
    const Vector2d& low = from.y() < to.y() ? from : to;
    const Vector2d& high = from.y() < to.y() ? to : from;
    const auto first = static_cast<std::int32_t>(std::ceil(low.y()));
    const auto end = static_cast<std::int32_t>(std::ceil(high.y()));
    if (first < end) {
      const double slope = (high.x() - low.x()) / (high.y() - low.y());
      for (std::int32_t row = first; row < end; ++row) {
        crossings_.push_back({row, static_cast<float>(low.x() + slope * (row - low.y()))});
      }
    }
    from = to;
  }
  std::sort(crossings_.begin(), crossings_.end(),
            [](const Crossing& a, const Crossing& b) { return a.row != b.row ? a.row < b.row : a.column < b.column; });
}

std::vector<RowSpan> row_spans(std::span<const Eigen::Vector2f> ring, const Pose2& T_plane_ring, double cell) {
  std::vector<RowSpan> spans;
  RowScanner().scan(ring, T_plane_ring, cell, [&spans](const RowSpan& span) { spans.push_back(span); });
  return spans;
}

std::int64_t shared_cells(std::span<const RowSpan> a, std::span<const RowSpan> b) {
  std::int64_t shared = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (a[i].row == b[j].row) {
      shared += std::max(0, std::min(a[i].last, b[j].last) - std::max(a[i].first, b[j].first) + 1);
    }
    const bool a_ends_first = a[i].row != b[j].row ? a[i].row < b[j].row : a[i].last < b[j].last;
    a_ends_first ? ++i : ++j;
  }
  return shared;
}

std::int64_t count_cells(std::span<const RowSpan> spans) {
  std::int64_t count = 0;
  for (const RowSpan& span : spans) count += span.last - span.first + 1;
  return count;
}

}  // namespace helicoid
