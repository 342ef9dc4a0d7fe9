#include "helicoid/navigation/bystanders.hpp"

#include <optional>

namespace helicoid {

namespace {

/// A robot that was not heard of for longer may have been anywhere, seconds.
constexpr double kHeard = 0.5;

/// Where a robot was at that time.
std::optional<ManifoldPoint> stand_at(const Trajectory& trajectory, double stamp) {
  const std::size_t at = trajectory.last_not_after(stamp);
  if (at >= trajectory.size() || stamp - trajectory.stamp(at) > kHeard) return std::nullopt;
  return point_of(trajectory[at].pose);
}

}  // namespace

void Bystanders::read(const Map& map) {
  const auto is_known = [&](std::size_t i) {
    const Patch& patch = map.patch(make_id<PatchId>(i));
    return patch.robot == of_patch_[i].robot && patch.stamp == of_patch_[i].stamp;
  };
  if (of_patch_.size() > map.patch_count() || (!of_patch_.empty() && !is_known(of_patch_.size() - 1))) of_patch_ = {};
  for (std::size_t i = of_patch_.size(); i < map.patch_count(); ++i) {
    const Patch& patch = map.patch(make_id<PatchId>(i));
    OfPatch of_patch{patch.robot, patch.stamp, {}};
    for (std::size_t r = 0; r < map.robots().size(); ++r) {
      if (r == patch.robot.index()) continue;
      if (const auto stand = stand_at(map.robots()[r].trajectory, patch.stamp)) of_patch.others.push_back(*stand);
    }
    of_patch_.push_back(std::move(of_patch));
  }
}

std::vector<Vector2d> Bystanders::about(const Map& map, PatchId patch) const {
  std::vector<Vector2d> stands;
  const double reach = map.patch(patch).reach;
  for (const ManifoldPoint& other : of_patch_[patch.index()].others) {
    if (map.island_of(other.patch) != map.island_of(patch)) continue;
    const Vector2d p_patch = map.T_plane_patch(patch).inverse() * project(map, other);
    if (p_patch.norm() < reach) stands.push_back(p_patch);
  }
  return stands;
}

}  // namespace helicoid
