#include "helicoid/manifold/coverage_sweep.hpp"

#include <algorithm>

#include "helicoid/geometry/row_spans.hpp"

namespace helicoid {

std::vector<CellSpan> covered_cells(const Map& map, std::span<const PatchId> patches, double cell) {
  std::vector<CellSpan> spans;
  RowScanner scanner;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const auto place = static_cast<std::uint32_t>(i);
    scanner.scan(map.patch(patches[i]).free_space, map.T_plane_patch(patches[i]), cell, [&](const RowSpan& span) {
      spans.push_back({span.row, span.first, span.last, place});
    });
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
