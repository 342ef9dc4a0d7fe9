// Which patches are neighbours, and how many sheets lie over one another (contract: *Sheets*).
#pragma once

#include <vector>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// For each patch (by id) the patches of its island whose free space overlaps its own in the plane and whose pose
/// relative to it is known to within eps; ascending.
using Neighbours = std::vector<std::vector<PatchId>>;

struct NeighbourOptions {
  double position = 0.10;  ///< eps of eq. 12, metres
  double heading = 0.035;  ///< radians
};
[[nodiscard]] Neighbours find_neighbours(const Map& map, const NeighbourOptions& options = {});

/// The sheets of one island.
struct Sheets {
  int count = 1;                ///< the largest number of groups of patches over one 10 cm cell; 1 = planar
  std::vector<int> sheet_of;    ///< by patch id: 0..count-1 a sheet to draw it on; -1 for patches of other islands
};
[[nodiscard]] Sheets find_sheets(const Map& map, const Neighbours& neighbours, IslandId island);

}  // namespace helicoid
