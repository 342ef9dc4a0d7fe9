// Which patches are neighbours (paper III-A, design 5.7): on one sheet, beside or over one another.
#pragma once

#include <vector>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// For each patch (by id) the patches whose free space overlaps its own in the plane (the first half of eq. 2, on a
/// 10 cm raster) and that are confident relative to it (eq. 12): by the exact covariance, midway between the two, so
/// that neither's frame is preferred. A scan's noise floor is left out: it is the same on one sheet and on two.
/// Ascending. Patches that overlap without being neighbours are, as far as the map knows, different places: one sheet
/// over the other.
using Neighbours = std::vector<std::vector<PatchId>>;

struct NeighbourOptions {
  double position = 0.15;  ///< eps of eq. 12, metres
  double heading = 0.06;   ///< radians
};
/// None where an island's relations leave some patch open.
[[nodiscard]] Neighbours find_neighbours(const Map& map, const NeighbourOptions& options = {});

}  // namespace helicoid
