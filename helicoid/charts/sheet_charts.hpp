// Grids of the sheets of an island, and the one picture that shows them together.
#pragma once

#include <span>
#include <vector>

#include "helicoid/charts/occupancy_grid.hpp"
#include "helicoid/manifold/sheets.hpp"

namespace helicoid {

/// One grid a sheet, all in the same frame, at least one. Patches that are on no sheet (of other islands) are left out.
[[nodiscard]] std::vector<OccupancyGrid> draw_sheets(const Map& map, std::span<const PatchId> patches,
                                                     const Sheets& sheets, const GridFrame& frame, int threads = 1,
                                                     const OccupancyModel& model = {});

/// Sheets laid over one another: where several know a cell the first of them is seen, never a blend.
struct SheetStack {
  OccupancyGrid grid;
  std::vector<std::uint8_t> depth;  ///< by cell: how many sheets know it (up to 255)
  int deepest = 0;                  ///< the largest depth
};
/// The same as stack(draw_sheets(...)), with no more than one sheet's grid in memory at a time.
[[nodiscard]] SheetStack draw_stack(const Map& map, std::span<const PatchId> patches, const Sheets& sheets,
                                    const GridFrame& frame, int threads = 1, const OccupancyModel& model = {});
[[nodiscard]] SheetStack stack(std::span<const OccupancyGrid> sheets);

}  // namespace helicoid
