#include "helicoid/mapping/local_map.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// Turned by a radian, a view has changed as much as over this many metres.
constexpr double kMetresPerRadian = 1.5;

double view_distance(const Pose2& T_anchor_patch, const Pose2& T_anchor_robot) {
  return std::hypot(T_anchor_patch.x - T_anchor_robot.x, T_anchor_patch.y - T_anchor_robot.y) +
         kMetresPerRadian * std::abs(wrap_angle(T_anchor_patch.yaw - T_anchor_robot.yaw));
}

}  // namespace

LocalMap find_local_map(const Map& map, const InformationGraph& graph, PatchId anchor, const BoundOptions& options) {
  LocalMap local;
  for (const BoundedPose& bounded : tree_bound(graph, map.poses(), anchor.value, options)) {
    local.push_back({PatchId{bounded.pose}, bounded.relative.T_a_b, bounded.relative.covariance});
  }
  return local;
}

std::vector<LocalPatch> select_views(const LocalMap& local, const Pose2& T_anchor_robot, std::size_t most) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 0; i < local.size(); ++i) {
    ranked.emplace_back(view_distance(local[i].T_anchor_patch, T_anchor_robot), i);
  }
  const std::size_t count = std::min(most, ranked.size());
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count), ranked.end());
  std::vector<LocalPatch> views;
  for (std::size_t i = 0; i < count; ++i) views.push_back(local[ranked[i].second]);
  return views;
}

}  // namespace helicoid
