// The local map of eq. 12: the patches near the robot's patch and well fitted with respect to it.
#pragma once

#include <span>
#include <vector>

#include "helicoid/align/reference.hpp"
#include "helicoid/fit/local_bound.hpp"
#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// A patch of the local map, seen from the anchor (the robot's patch pi_t).
struct LocalPatch {
  PatchId patch;
  Pose2 T_anchor_patch;
  Matrix3d covariance = Matrix3d::Zero();  ///< an upper bound, in the anchor's frame
};

/// The anchor first.
using LocalMap = std::vector<LocalPatch>;

[[nodiscard]] LocalMap find_local_map(const Map& map, const InformationGraph& graph, PatchId anchor,
                                      const BoundOptions& options);

/// The patches that best show what a robot at this pose sees: near, and looking the same way.
[[nodiscard]] std::vector<LocalPatch> select_views(const LocalMap& local, const Pose2& T_anchor_robot,
                                                   std::size_t most);

}  // namespace helicoid
