#include "helicoid/mapping/sighting_log.hpp"

#include <algorithm>

namespace helicoid {

namespace {

constexpr double kSameStamp = 2e-6;  ///< a trajectory's stamps are rounded, seconds

}  // namespace

std::optional<ManifoldPose> place_at(const Map& map, RobotId robot, double stamp, bool last) {
  const auto& scans = map.robot(robot).trajectory;
  // From the end: stamps may step back, and a sighting is recent.
  for (std::size_t i = scans.size(); i-- > 0;) {
    const TrackedScan before = scans[i];
    if (before.stamp > stamp + kSameStamp) continue;
    if (i + 1 == scans.size()) {
      if (last || before.stamp >= stamp - kSameStamp) return before.pose;
      return std::nullopt;
    }
    const TrackedScan after = scans[i + 1];
    const double share = std::max(0.0, stamp - before.stamp) / std::max(after.stamp - before.stamp, 1e-9);
    const Pose2 T_before_after = map.project(before.pose).inverse() * map.project(after.pose);
    return ManifoldPose{before.pose.patch,
                        before.pose.T_patch_robot * exponential(std::min(share, 1.0) * logarithm(T_before_after))};
  }
  return std::nullopt;
}

void SightingLog::add(RobotId observer, RobotId observed, double stamp, const Sighting& sighting) {
  waiting_.push_back({observer, observed, stamp, sighting});
}

void SightingLog::place_waiting(const Map& map, bool last) {
  std::erase_if(waiting_, [&](const Waiting& w) {
    const std::optional<ManifoldPose> observer = place_at(map, w.observer, w.stamp, last);
    const std::optional<ManifoldPose> observed = place_at(map, w.observed, w.stamp, last);
    if (!observer || !observed) return false;
    placed_.push_back({*observer, *observed, w.sighting});
    fresh_ = true;
    return true;
  });
}

std::optional<IslandJoin> SightingLog::find_join(const Map& map, bool last) {
  if (waiting_.empty() && !fresh_) return std::nullopt;
  place_waiting(map, last);
  if (!fresh_) return std::nullopt;
  std::erase_if(placed_, [&](const PlacedSighting& s) {
    return map.island_of(s.observer.patch) == map.island_of(s.observed.patch);
  });
  for (std::size_t i = placed_.size(); i-- > 0;) {
    const IslandId a = map.island_of(placed_[i].observer.patch);
    const IslandId b = map.island_of(placed_[i].observed.patch);
    std::vector<PlacedSighting> between;
    for (std::size_t k = 0; k <= i; ++k) {
      const IslandId x = map.island_of(placed_[k].observer.patch);
      const IslandId y = map.island_of(placed_[k].observed.patch);
      if ((x == a && y == b) || (x == b && y == a)) between.push_back(placed_[k]);
    }
    const IslandJoin join = estimate_join(map, between);
    if (join.determined) return join;
  }
  fresh_ = false;
  return std::nullopt;
}

}  // namespace helicoid
