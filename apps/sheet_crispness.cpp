#include "apps/sheet_crispness.hpp"

#include <algorithm>

#include "helicoid/manifold/sheets.hpp"

namespace helicoid {

SheetCrispness crispness_by_sheet(const Map& map) {
  SheetCrispness all;
  const Neighbours neighbours = find_neighbours(map);
  for (const Island& island : map.islands()) {
    const Sheets on = find_sheets(map, neighbours, island);
    all.sheets = std::max(all.sheets, on.count);
    const int drawn = 1 + *std::max_element(on.sheet_of.begin(), on.sheet_of.end());
    for (int sheet = 0; sheet < drawn; ++sheet) {
      std::vector<PatchId> patches;
      for (const PatchId id : island.patches) {
        if (on.sheet_of[id.index()] == sheet) patches.push_back(id);
      }
      const Crispness c = measure_crispness(map, patches, draw_occupancy(map, patches, frame_around(map, patches)));
      all.total.occupied += c.occupied;
      all.total.twins += c.twins;
      all.total.seen_at_once += c.seen_at_once;
    }
  }
  if (all.total.occupied > 0)
    all.total.share = static_cast<double>(all.total.twins) / static_cast<double>(all.total.occupied);
  return all;
}

}  // namespace helicoid
