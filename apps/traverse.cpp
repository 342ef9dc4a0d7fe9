#include "apps/traverse.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "apps/map_run.hpp"
#include "apps/planar_route.hpp"
#include "helicoid/navigation/where_am_i.hpp"

namespace helicoid {

namespace {

/// A robot that is still within this of where it was has got nowhere, metres.
constexpr double kGotSomewhere = 0.5;

/// How long the robot's limits let it take for a route: along it, and turning on the spot at its bends.
double path_time(const Map& map, const ManifoldRoute& route, const ManifoldPose& from, const FollowerOptions& limits) {
  double heading = map.project(from).yaw;
  double turns = 0;
  for (std::size_t i = 1; i < route.points.size(); ++i) {
    const Vector2d way = project(map, route.points[i]) - project(map, route.points[i - 1]);
    if (way.norm() < 0.05) continue;
    const double next = std::atan2(way.y(), way.x());
    turns += std::abs(wrap_angle(next - heading));
    heading = next;
  }
  return route.length / limits.top_speed + turns / limits.top_turn_rate;
}

/// One traverse as it goes on.
class Attempt {
 public:
  Attempt(LiveMapping& mapping, const Planner& planner, const ManifoldPoint& goal, const Vector2d& p_world_goal,
          const TraverseOptions& options)
      : mapping_(mapping),
        planner_(planner),
        goal_(goal),
        p_world_goal_(p_world_goal),
        options_(options),
        follower_(options.follower),
        contacts_(mapping.simulation().collisions()),
        began_(mapping.simulation().now()) {}

  Traverse drive() {
    std::optional<TraverseEnd> end;
    if (!plan()) end = TraverseEnd::no_plan;
    while (!end) end = tick();
    mapping_.command(0, {});
    traverse_.end = *end;
    traverse_.off_m = off();
    traverse_.time_s = now();
    return std::move(traverse_);
  }

 private:
  [[nodiscard]] double now() const { return mapping_.simulation().now() - began_; }
  [[nodiscard]] double off() const {
    return (mapping_.simulation().T_world_robot(0).translation() - p_world_goal_).norm();
  }

  bool plan() {
    const double before = thread_cpu_seconds();
    ManifoldRoute route = planner_(mapping_.map(), mapping_.pose(0), goal_);
    traverse_.plan_cpu_s = std::max(traverse_.plan_cpu_s, thread_cpu_seconds() - before);
    planned_ = now();
    if (route.status != RouteStatus::found) return false;
    if (traverse_.allowed_s == 0) {
      traverse_.length_m = route.length;
      traverse_.allowed_s =
          options_.times_the_path * path_time(mapping_.map(), route, mapping_.pose(0), options_.follower);
    } else {
      ++traverse_.replans;
    }
    follower_.follow(std::move(route));
    return true;
  }

  std::optional<TraverseEnd> tick() {
    const FollowStep step = follower_.step(mapping_.map(), mapping_.pose(0), mapping_.scan(0),
                                           mapping_.simulation().laser(), options_.period);
    traverse_.way.push_back(mapping_.simulation().T_world_robot(0));
    if (mapping_.simulation().collisions() > contacts_) return TraverseEnd::collision;
    if (now() > traverse_.allowed_s || is_stuck()) return TraverseEnd::late;
    if (step.status == FollowStatus::arrived) {
      if (looks_for_goal()) return std::nullopt;
      return off() <= options_.arrived_m ? TraverseEnd::arrived : TraverseEnd::wrong_place;
    }
    const bool blocked = step.status == FollowStatus::blocked;
    traverse_.blocked += blocked && !was_blocked_ ? 1 : 0;
    was_blocked_ = blocked;
    if (blocked && now() - planned_ >= options_.replan_every) plan();
    mapping_.command(0, step.command);
    mapping_.tick();
    return std::nullopt;
  }

  /// Where the robot's sheet is not the goal's, it stands in the right place as the plane has it, which may be wrong:
  /// it turns about until its scan tells where the goal is from here, a full turn at most. False: it need not, or has.
  bool looks_for_goal() {
    const Map& map = mapping_.map();
    const ManifoldPose here = mapping_.pose(0);
    if (looked_ || here.patch == goal_.patch) return false;
    const Neighbours neighbours = find_neighbours(map);
    const std::vector<PatchId>& of_goal = neighbours[goal_.patch.index()];
    if (std::binary_search(of_goal.begin(), of_goal.end(), here.patch)) return false;
    const auto found =
        find_on_sheet(map, neighbours, goal_.patch, here, mapping_.scan(0), mapping_.simulation().laser());
    turned_ += options_.follower.top_turn_rate * options_.period;
    looked_ = found || turned_ > 2 * std::numbers::pi;
    if (found) {
      goal_ = {here.patch, here.T_patch_robot * (found->T_patch_robot.inverse() * goal_.p_patch)};
      plan();
    } else {
      mapping_.command(0, {0, options_.follower.top_turn_rate});
      mapping_.tick();
    }
    return true;
  }

  bool is_stuck() {
    const Vector2d here = mapping_.simulation().T_world_robot(0).translation();
    if (!p_world_stuck_ || (here - *p_world_stuck_).norm() > kGotSomewhere) {
      p_world_stuck_ = here;
      stuck_since_ = now();
    }
    return now() - stuck_since_ > options_.gives_up_after;
  }

  LiveMapping& mapping_;
  const Planner& planner_;
  ManifoldPoint goal_;
  Vector2d p_world_goal_;
  const TraverseOptions& options_;
  RouteFollower follower_;
  std::size_t contacts_;
  double began_;
  double planned_ = 0;
  bool was_blocked_ = false;
  std::optional<Vector2d> p_world_stuck_;
  double stuck_since_ = 0;
  double turned_ = 0;    ///< to look for the goal, radians
  bool looked_ = false;  ///< for it, in vain or not
  Traverse traverse_;
};

}  // namespace

Planner manifold_planner() {
  auto before = std::make_shared<std::optional<NavigableMap>>();
  return [before](const Map& map, const ManifoldPose& from, const ManifoldPoint& goal) {
    NavigableMap now(map, find_neighbours(map), {}, *before ? &**before : nullptr);
    *before = std::move(now);
    return plan_route(**before, from, goal);
  };
}

Planner planar_planner() {
  auto planner = std::make_shared<PlanarPlanner>();
  return [planner](const Map& map, const ManifoldPose& from, const ManifoldPoint& goal) {
    return planner->plan(map, from, goal);
  };
}

Traverse retro_traverse(LiveMapping& mapping, const Planner& planner, const ManifoldPoint& goal,
                        const Vector2d& p_world_goal, const TraverseOptions& options) {
  return Attempt(mapping, planner, goal, p_world_goal, options).drive();
}

}  // namespace helicoid
