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

namespace {

/// Where a patch begins or ends in a row. Keys ascend by column; at one column patches end before others begin.
struct Edge {
  std::uint64_t key = 0;

  Edge() = default;
  Edge(std::int32_t column, bool enters, std::uint32_t patch)
      : key((static_cast<std::uint64_t>(static_cast<std::uint32_t>(column) ^ 0x80000000U) << 32U) |
            (static_cast<std::uint64_t>(enters) << 31U) | patch) {}
  [[nodiscard]] std::int32_t column() const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> 32U) ^ 0x80000000U);
  }
  [[nodiscard]] bool enters() const { return (key >> 31U & 1U) != 0; }
  [[nodiscard]] std::uint32_t patch() const { return static_cast<std::uint32_t>(key & 0x7FFFFFFFU); }
};

/// The edges of all rows that are multiples of a step: row k's are edges[start[k]..start[k + 1]), in no order.
struct EdgesByRow {
  std::int32_t first_row = 0;
  std::vector<std::size_t> start;
  std::vector<Edge> edges;
};

EdgesByRow edges_by_row(std::span<const CellSpan> spans, int row_step) {
  EdgesByRow rows;
  if (spans.empty()) return rows;
  const auto by_row = [](const CellSpan& a, const CellSpan& b) { return a.row < b.row; };
  const auto [low, high] = std::minmax_element(spans.begin(), spans.end(), by_row);
  rows.first_row = low->row;
  rows.start.assign(static_cast<std::size_t>(high->row - low->row) + 2, 0);
  const auto row_of = [&](const CellSpan& span) { return static_cast<std::size_t>(span.row - rows.first_row); };
  for (const CellSpan& span : spans) {
    if (span.row % row_step == 0) rows.start[row_of(span) + 1] += 2;
  }
  for (std::size_t k = 1; k < rows.start.size(); ++k) rows.start[k] += rows.start[k - 1];
  rows.edges.resize(rows.start.back());
  std::vector<std::size_t> next(rows.start.begin(), rows.start.end() - 1);
  for (const CellSpan& span : spans) {
    if (span.row % row_step != 0) continue;
    std::size_t& at = next[row_of(span)];
    rows.edges[at++] = Edge(span.first, true, span.patch);
    rows.edges[at++] = Edge(span.last + 1, false, span.patch);
  }
  return rows;
}

}  // namespace

void sweep_coverage(std::span<const CellSpan> spans, int row_step,
                    const std::function<void(const CoveredRun&)>& visit) {
  EdgesByRow rows = edges_by_row(spans, row_step);
  std::vector<std::uint32_t> active;
  for (std::size_t k = 0; k + 1 < rows.start.size(); ++k) {
    const std::span<Edge> edges = std::span(rows.edges).subspan(rows.start[k], rows.start[k + 1] - rows.start[k]);
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.key < b.key; });
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Edge& edge = edges[i];
      const auto at = std::lower_bound(active.begin(), active.end(), edge.patch());
      if (edge.enters()) {
        active.insert(at, edge.patch());
      } else {
        active.erase(at);
      }
      if (active.empty() || edges[i + 1].column() == edge.column()) continue;
      visit({rows.first_row + static_cast<std::int32_t>(k), edge.column(), edges[i + 1].column() - 1, active});
    }
  }
}

}  // namespace helicoid
