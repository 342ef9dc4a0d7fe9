// How many sheets of the manifold lie over one another (contract: *Sheets*), and which patch is on which.
#pragma once

#include <vector>

#include "helicoid/manifold/map.hpp"
#include "helicoid/manifold/neighbours.hpp"

namespace helicoid {

/// The largest number, over all 10 cm cells of an island's plane, of groups of patches covering that cell; two patches
/// are in one group if a chain of neighbours, all within 10 m of the cell, joins them. 1 = planar.
[[nodiscard]] int count_sheets(const Map& map, const Neighbours& neighbours, const Island& island);

/// The sheets of one island, to be drawn one by one.
struct Sheets {
  int count = 1;              ///< as count_sheets has it
  std::vector<int> sheet_of;  ///< by patch id: 0, 1, ... a sheet on which no two groups cover one cell; -1 elsewhere
};
[[nodiscard]] Sheets find_sheets(const Map& map, const Neighbours& neighbours, const Island& island);

}  // namespace helicoid
