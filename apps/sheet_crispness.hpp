// How crisp a whole map is, sheet by sheet.
#pragma once

#include "helicoid/charts/crispness.hpp"
#include "helicoid/manifold/map.hpp"

namespace helicoid {

struct SheetCrispness {
  Crispness total;  ///< sums over all sheets of all islands
  int sheets = 0;   ///< of the island that has most
};

/// What lies on another sheet is another place, and no twin.
[[nodiscard]] SheetCrispness crispness_by_sheet(const Map& map);

}  // namespace helicoid
