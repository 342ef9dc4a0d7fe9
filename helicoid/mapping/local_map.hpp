// The local map of eq. 12: the patches near the robot's patch and well fitted with respect to it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "helicoid/align/reference.hpp"
#include "helicoid/fit/joint_bound.hpp"
#include "helicoid/manifold/map.hpp"
#include "helicoid/mapping/mapper_options.hpp"

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
/// The same with the mapper's own limits: what is matched with.
[[nodiscard]] LocalMap find_local_map(const Map& map, const InformationGraph& graph, PatchId anchor,
                                      const MapperOptions& options);

/// Of those that show the same place from the same side the oldest, so that it costs no more to find one's way where
/// many laps left their patches. The anchor first and `last_kept` in any case.
[[nodiscard]] LocalMap distinct_places(const LocalMap& local, PatchId last_kept);

/// The patches nearest to a robot at this pose, those that look the same way first.
[[nodiscard]] std::vector<LocalPatch> nearest_views(const LocalMap& local, const Pose2& T_anchor_robot,
                                                    std::size_t most);

/// Eq. 14: on which patch a robot at this pose stands, as its place in the local map: the nearest of those that know
/// the robot's place (paper III-A: r lies inside s), but the anchor as long as it does and is not much farther, so that
/// the anchor does not flutter. Nothing where no patch knows the robot's place.
[[nodiscard]] std::optional<std::size_t> choose_anchor(const Map& map, const LocalMap& local,
                                                       const Pose2& T_anchor_robot);

/// The patches to match a scan with: the one kept last, and those that together saw most of the surfaces that the scan
/// sees, whichever way they look. Every second one is the oldest of the good ones, so that whoever re-walks known
/// ground holds on to what was there first instead of to what it has just added.
[[nodiscard]] std::vector<LocalPatch> select_views(const Map& map, const LocalMap& local, const ScanPoints& points,
                                                   const Pose2& T_anchor_robot, PatchId last_kept, std::size_t most);

/// What a Reference in the anchor's frame is built from.
[[nodiscard]] std::vector<ReferencePart> reference_parts(const Map& map, std::span<const LocalPatch> views);

}  // namespace helicoid
