#include "apps/order_effect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "helicoid/eval/trajectory_error.hpp"
#include "helicoid/manifold/stated_confidence.hpp"

namespace helicoid {

namespace {

constexpr double kElsewhere = 0.10;  // metres

/// What the other map says about the places of this one's closures.
struct ClosuresThere {
  double apart_m = 0;  ///< the most; infinity: on different islands, or nothing is said of it
  std::size_t elsewhere = 0;
};

/// The scan that a patch was made from.
StatedConfidence::TakenScan taken(const Patch& patch) {
  return {patch.robot, patch.scan_index};
}

/// The island on which the other map has a scan; nothing if it does not have it.
std::optional<IslandId> island_of(const Map& other, const StatedConfidence::TakenScan& scan) {
  const Trajectory& trajectory = other.robot(scan.robot).trajectory;
  if (scan.index >= trajectory.size()) return std::nullopt;
  return other.island_of(trajectory[scan.index].pose.patch);
}

ClosuresThere closures_there(const Mapper& mapper, const Map& other) {
  ClosuresThere there;
  std::map<IslandId, StatedConfidence> stated;
  for (const Island& island : other.islands()) stated.try_emplace(island.id, other, island);
  const Map& map = mapper.map();
  for (const Hypothesis& h : mapper.ledger()) {
    if (!h.is_closure()) continue;
    const StatedConfidence::TakenScan a = taken(map.patch(h.a));
    const StatedConfidence::TakenScan b = taken(map.patch(h.b));
    const std::optional<IslandId> island = island_of(other, a);
    if (!island || island != island_of(other, b) || !stated.at(*island).is_determined()) {
      there.apart_m = std::numeric_limits<double>::infinity();
      ++there.elsewhere;
      continue;
    }
    const Pose2 T_a_b = map.T_plane_patch(h.a).inverse() * map.T_plane_patch(h.b);
    const UncertainPose2 said = stated.at(*island).between(a, b);
    const double apart = (said.T_a_b.translation() - T_a_b.translation()).norm();
    there.apart_m = std::max(there.apart_m, apart);
    if (apart > kElsewhere && is_beyond_said(said, T_a_b)) ++there.elsewhere;
  }
  return there;
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
  const ClosuresThere in_stamped = closures_there(heard, stamped.map());
  const ClosuresThere in_heard = closures_there(stamped, heard.map());
  effect.closures_apart_m = std::max(in_stamped.apart_m, in_heard.apart_m);
  effect.closures_elsewhere = in_stamped.elsewhere + in_heard.elsewhere;
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
  for (const RobotRecord& robot : heard.map().robots()) effect.scans_heard.push_back(robot.trajectory.size());
  return effect;
}

}  // namespace helicoid
