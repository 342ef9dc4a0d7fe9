#include "helicoid/manifold/coverage_sweep.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// Where a polygon's edges cross the rows' centre lines: one column value per crossing, row by row.
struct Crossing {
  std::int32_t row;
  float column;
};

void collect_crossings(const std::vector<Eigen::Vector2f>& ring, const Pose2& T_plane_patch, double cell,
                       std::vector<Crossing>& crossings) {
  crossings.clear();
  const double per_cell = 1 / cell;
  const auto c = std::cos(T_plane_patch.yaw);
  const auto s = std::sin(T_plane_patch.yaw);
  const auto to_cells = [&](const Eigen::Vector2f& p) {
    const double x = p.x();
    const double y = p.y();
    return Vector2d((T_plane_patch.x + c * x - s * y) * per_cell - 0.5,
                    (T_plane_patch.y + s * x + c * y) * per_cell - 0.5);
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
        crossings.push_back({row, static_cast<float>(low.x() + slope * (row - low.y()))});
      }
    }
    from = to;
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  });
}

}  // namespace

std::vector<CellSpan> covered_cells(const Map& map, std::span<const PatchId> patches, double cell) {
  std::vector<CellSpan> spans;
  std::vector<Crossing> crossings;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Patch& patch = map.patch(patches[i]);
    if (patch.free_space.empty()) continue;
    collect_crossings(patch.free_space, map.T_plane_patch(patches[i]), cell, crossings);
    // Between an odd and an even crossing of a row lies the inside.
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const auto first = static_cast<std::int32_t>(std::ceil(crossings[k].column));
      const auto last = static_cast<std::int32_t>(std::ceil(crossings[k + 1].column)) - 1;
      if (first <= last) spans.push_back({crossings[k].row, first, last, static_cast<std::uint32_t>(i)});
    }
  }
  return spans;
}

void sweep_coverage(std::span<const CellSpan> spans, int row_step,
                    const std::function<void(const CoveredRun&)>& visit) {
  struct Edge {
    std::int32_t row;
    std::int32_t column;
    std::uint32_t patch;
    bool enters;
  };
  std::vector<Edge> edges;
  for (const CellSpan& span : spans) {
    if (span.row % row_step != 0) continue;
    edges.push_back({span.row, span.first, span.patch, true});
    edges.push_back({span.row, span.last + 1, span.patch, false});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    if (a.row != b.row) return a.row < b.row;
    if (a.column != b.column) return a.column < b.column;
    if (a.enters != b.enters) return b.enters;
    return a.patch < b.patch;
  });
  std::vector<std::uint32_t> active;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = edges[i];
    const auto at = std::lower_bound(active.begin(), active.end(), edge.patch);
    if (edge.enters) {
      active.insert(at, edge.patch);
    } else {
      active.erase(at);
    }
    if (active.empty() || edges[i + 1].column == edge.column) continue;
    visit({edge.row, edge.column, edges[i + 1].column - 1, active});
  }
}

}  // namespace helicoid
