#include "helicoid/charts/sheet_charts.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace helicoid {

namespace {

std::vector<std::vector<PatchId>> by_sheet(std::span<const PatchId> patches, const Sheets& sheets) {
  std::vector<std::vector<PatchId>> of_sheet(1);
  for (const PatchId id : patches) {
    const int sheet = id.index() < sheets.sheet_of.size() ? sheets.sheet_of[id.index()] : -1;
    if (sheet < 0) continue;
    const auto place = static_cast<std::size_t>(sheet);
    if (place >= of_sheet.size()) of_sheet.resize(place + 1);
    of_sheet[place].push_back(id);
  }
  return of_sheet;
}

SheetStack empty_stack(const GridFrame& frame, const OccupancyModel& model) {
  return {{frame, std::vector<std::uint16_t>(frame.size()), std::vector<std::uint16_t>(frame.size()), model},
          std::vector<std::uint8_t>(frame.size()),
          0};
}

/// The stack with one more sheet beneath it.
SheetStack with_beneath(SheetStack above, const OccupancyGrid& sheet) {
  for (std::size_t cell = 0; cell < above.depth.size(); ++cell) {
    if (!sheet.seen(cell)) continue;
    if (above.depth[cell] == 0) {
      above.grid.hits[cell] = sheet.hits[cell];
      above.grid.misses[cell] = sheet.misses[cell];
    }
    if (above.depth[cell] < 255) ++above.depth[cell];
    above.deepest = std::max<int>(above.deepest, above.depth[cell]);
  }
  return above;
}

}  // namespace

std::vector<OccupancyGrid> draw_sheets(const Map& map, std::span<const PatchId> patches, const Sheets& sheets,
                                       const GridFrame& frame, int threads, const OccupancyModel& model) {
  std::vector<OccupancyGrid> grids;
  for (const auto& members : by_sheet(patches, sheets)) {
    grids.push_back(draw_occupancy(map, members, frame, threads, model));
  }
  return grids;
}

SheetStack draw_stack(const Map& map, std::span<const PatchId> patches, const Sheets& sheets, const GridFrame& frame,
                      int threads, const OccupancyModel& model) {
  SheetStack result = empty_stack(frame, model);
  for (const auto& members : by_sheet(patches, sheets)) {
    result = with_beneath(std::move(result), draw_occupancy(map, members, frame, threads, model));
  }
  return result;
}

SheetStack stack(std::span<const OccupancyGrid> sheets) {
  assert(!sheets.empty());
  SheetStack result = empty_stack(sheets.front().frame, sheets.front().model);
  for (const OccupancyGrid& sheet : sheets) result = with_beneath(std::move(result), sheet);
  return result;
}

}  // namespace helicoid
