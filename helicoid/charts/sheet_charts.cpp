#include "helicoid/charts/sheet_charts.hpp"

#include <algorithm>
#include <cassert>

namespace helicoid {

std::vector<OccupancyGrid> draw_sheets(const Map& map, std::span<const PatchId> patches, const Sheets& sheets,
                                       const GridFrame& frame, int threads, const OccupancyModel& model) {
  std::vector<std::vector<PatchId>> of_sheet(1);
  for (const PatchId id : patches) {
    const int sheet = id.index() < sheets.sheet_of.size() ? sheets.sheet_of[id.index()] : -1;
    if (sheet < 0) continue;
    const auto place = static_cast<std::size_t>(sheet);
    if (place >= of_sheet.size()) of_sheet.resize(place + 1);
    of_sheet[place].push_back(id);
  }
  std::vector<OccupancyGrid> grids;
  grids.reserve(of_sheet.size());
  for (const auto& members : of_sheet) grids.push_back(draw_occupancy(map, members, frame, threads, model));
  return grids;
}

SheetStack stack(std::span<const OccupancyGrid> sheets) {
  assert(!sheets.empty());
  SheetStack result{sheets.front(), std::vector<std::uint8_t>(sheets.front().frame.size()), 0};
  for (std::size_t cell = 0; cell < result.depth.size(); ++cell) {
    int depth = 0;
    for (const OccupancyGrid& sheet : sheets) {
      if (!sheet.seen(cell)) continue;
      if (depth++ > 0) continue;
      result.grid.hits[cell] = sheet.hits[cell];
      result.grid.misses[cell] = sheet.misses[cell];
    }
    result.depth[cell] = static_cast<std::uint8_t>(std::min(depth, 255));
    result.deepest = std::max(result.deepest, depth);
  }
  return result;
}

}  // namespace helicoid
