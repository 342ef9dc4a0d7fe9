// Which patches cover which cells of the plane: a sweep over the rows of a raster, interval by interval, so that its
// cost follows the outlines of the free space and not its area.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// The cells of one row that one patch covers: columns first..last, both covered. Cell (c, r) has its centre at
/// ((c + 0.5) cell, (r + 0.5) cell) in the island's plane.
struct CellSpan {
  std::int32_t row = 0;
  std::int32_t first = 0;
  std::int32_t last = 0;
  std::uint32_t patch = 0;  ///< the patch's place in the list that was asked for
};

/// The cells whose centres lie in these patches' free space, patch by patch, rows ascending.
[[nodiscard]] std::vector<CellSpan> covered_cells(const Map& map, std::span<const PatchId> patches, double cell);

/// Cells of a row that the same set of patches covers.
struct CoveredRun {
  std::int32_t row = 0;
  std::int32_t first = 0;
  std::int32_t last = 0;
  std::span<const std::uint32_t> patches;  ///< places in the list, ascending; at least one
};

/// Calls `visit` for every run of every row that is a multiple of `row_step`, in order of row and column.
void sweep_coverage(std::span<const CellSpan> spans, int row_step, const std::function<void(const CoveredRun&)>& visit);

}  // namespace helicoid
