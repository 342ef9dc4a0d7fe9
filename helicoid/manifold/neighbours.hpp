// Which patches are neighbours, and which merely lie over one another (paper III-A; design 5.7).
#pragma once

#include <vector>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// By patch id, ascending lists of patches of the same island.
struct Neighbours {
  /// Free space overlaps in the plane (the first half of eq. 2) and each is confident relative to the other (eq. 12).
  std::vector<std::vector<PatchId>> of;
  /// Free space overlaps in the plane, but nothing says how the two lie: as far as the map knows they are different
  /// places, one sheet over the other.
  std::vector<std::vector<PatchId>> strangers;
};

struct NeighbourOptions {
  double position = 0.10;  ///< eps of eq. 12, metres
  double heading = 0.035;  ///< radians
};
[[nodiscard]] Neighbours find_neighbours(const Map& map, const NeighbourOptions& options = {});

/// True if the free-space polygons of two patches overlap at this relative pose: by some tens of samples of either.
[[nodiscard]] bool free_space_overlaps(const Patch& a, const Patch& b, const Pose2& T_a_b);

}  // namespace helicoid
