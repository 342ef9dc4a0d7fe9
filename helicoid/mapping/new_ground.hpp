// When a scan is kept as a patch (paper IV-A, after eq. 14): it is far from every patch, or it sees new ground.
#pragma once

#include "helicoid/mapping/local_map.hpp"
#include "helicoid/mapping/mapper_options.hpp"

namespace helicoid {

/// The first trigger: no patch of the local map is near and looks the same way. `share` of the spacing counts as far.
[[nodiscard]] bool is_far_from_all(const LocalMap& local, const Pose2& T_anchor_robot, const MapperOptions& options,
                                   double share = 1);

/// Of a scan's free space, 0..1.
struct UncoveredShare {
  double of_all = 0;
  double of_near = 0;  ///< of what lies within a few metres
};
/// The second: the share of the scan's free space that no patch of the local map covers, by sampling.
[[nodiscard]] UncoveredShare uncovered_share(const Map& map, const LocalMap& local, const Pose2& T_anchor_robot,
                                             const Scan& scan, const ScanPointExtractor& extractor);

/// True if a pose has moved by more than this distance (metres) or angle (radians).
[[nodiscard]] bool has_moved(const Pose2& from, const Pose2& to, double distance, double angle);

}  // namespace helicoid
