#include "apps/order_effect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "helicoid/eval/trajectory_error.hpp"

namespace helicoid {

namespace {

/// Where the other map has the scan that a patch of this one was made from; nothing if it does not have it.
std::optional<ManifoldPose> elsewhere(const Patch& patch, const Map& other) {
  const Trajectory& trajectory = other.robot(patch.robot).trajectory;
  if (patch.scan_index >= trajectory.size()) return std::nullopt;
  return trajectory[patch.scan_index].pose;
}

/// The most that the other map has the places of this one's closures elsewhere to each other, metres. Infinity: on
/// different islands, or not at all.
double closures_apart(const Mapper& mapper, const Map& other) {
  double most = 0;
  const Map& map = mapper.map();
  for (const Hypothesis& h : mapper.ledger()) {
    if (!h.is_closure()) continue;
    const std::optional<ManifoldPose> a = elsewhere(map.patch(h.a), other);
    const std::optional<ManifoldPose> b = elsewhere(map.patch(h.b), other);
    if (!a || !b || other.island_of(a->patch) != other.island_of(b->patch)) {
      return std::numeric_limits<double>::infinity();
    }
    const Pose2 T_a_b = map.T_plane_patch(h.a).inverse() * map.T_plane_patch(h.b);
    const Pose2 T_a_b_other = other.project(*a).inverse() * other.project(*b);
    most = std::max(most, (T_a_b.translation() - T_a_b_other.translation()).norm());
  }
  return most;
}

/// The island of each robot's scans; one that has none is nowhere.
std::vector<std::size_t> islands_of_robots(const Map& map) {
  constexpr std::size_t kNowhere = 1U << 30U;
  std::vector<std::size_t> islands;
  for (const RobotRecord& robot : map.robots()) {
    islands.push_back(robot.trajectory.empty() ? kNowhere : map.island_of(robot.trajectory.front().pose.patch).index());
  }
  return islands;
}

/// True if whoever shares an island in one map does in the other.
bool share_alike(const std::vector<std::size_t>& x, const std::vector<std::size_t>& y) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if ((x[i] == x[k]) != (y[i] == y[k])) return false;
    }
  }
  return true;
}

struct PosePairs {
  std::vector<Pose2> heard, stamped;
};

/// By island of the map by stamps.
std::map<std::size_t, PosePairs> pairs_of(const Map& heard, const Map& stamped) {
  std::map<std::size_t, PosePairs> pairs;
  for (std::size_t r = 0; r < stamped.robots().size(); ++r) {
    const Trajectory& x = heard.robots()[r].trajectory;
    const Trajectory& y = stamped.robots()[r].trajectory;
    auto at = x.begin();
    for (auto scan = y.begin(); scan != y.end() && at != x.end(); ++scan, ++at) {
      PosePairs& of_island = pairs[stamped.island_of((*scan).pose.patch).index()];
      of_island.heard.push_back(heard.project((*at).pose));
      of_island.stamped.push_back(stamped.project((*scan).pose));
    }
  }
  return pairs;
}

Pose2 best_transform(const PosePairs& pairs) {
  std::vector<Vector2d> from;
  std::vector<Vector2d> to;
  for (std::size_t i = 0; i < pairs.heard.size(); ++i) {
    for (const Vector2d& p_robot : {Vector2d(0, 0), Vector2d(1, 0)}) {
      from.push_back(pairs.heard[i] * p_robot);
      to.push_back(pairs.stamped[i] * p_robot);
    }
  }
  return align_points(from, to);
}

}  // namespace

OrderEffect compare_orders(const Mapper& heard, const Mapper& stamped) {
  OrderEffect effect;
  effect.same_islands = share_alike(islands_of_robots(heard.map()), islands_of_robots(stamped.map()));
  effect.closures_heard = count_closures(heard.ledger());
  effect.closures_stamped = count_closures(stamped.ledger());
  effect.closures_apart_m = std::max(closures_apart(heard, stamped.map()), closures_apart(stamped, heard.map()));
  double count = 0;
  for (const auto& [island, pairs] : pairs_of(heard.map(), stamped.map())) {
    const Pose2 T_stamped_heard = best_transform(pairs);
    for (std::size_t i = 0; i < pairs.heard.size(); ++i) {
      const Pose2 off = pairs.stamped[i].inverse() * (T_stamped_heard * pairs.heard[i]);
      const double turn = std::abs(degrees(wrap_angle(off.yaw)));
      effect.mean_m += off.distance();
      effect.mean_deg += turn;
      effect.farthest_m = std::max(effect.farthest_m, off.distance());
      effect.farthest_deg = std::max(effect.farthest_deg, turn);
      ++count;
    }
  }
  effect.mean_m /= std::max(count, 1.0);
  effect.mean_deg /= std::max(count, 1.0);
  return effect;
}

}  // namespace helicoid
