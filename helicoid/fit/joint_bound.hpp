// The local bound of design 5.3 from all relations among the poses about the reference, not from a tree alone: tighter
// where several weak relations make a strong one, as at a door.
#pragma once

#include <span>
#include <vector>

#include "helicoid/fit/local_bound.hpp"

namespace helicoid {

struct JointBoundOptions {
  double slack = 3;        ///< poses are followed along the tree until this many times the limits
  std::size_t joint = 32;  ///< poses that are worked out together: those nearest to the reference in the plane
};

/// The poses that are surely confident relative to `reference` (eq. 12), the reference first, then in order of growing
/// spread; each with an upper bound of its covariance. What the tree already shows is not worked out again. Never
/// smaller than the exact covariance, never larger than the tree's.
[[nodiscard]] std::vector<BoundedPose> joint_bound(const InformationGraph& graph, std::span<const Pose2> T_plane,
                                                   std::uint32_t reference, const BoundOptions& options = {},
                                                   const JointBoundOptions& joint = {});

}  // namespace helicoid
