// One drive to a place that was visited before, while the map goes on growing: retro-traverse (design 5.7).
#pragma once

#include <functional>

#include "apps/live_mapping.hpp"
#include "helicoid/navigation/route_follower.hpp"

namespace helicoid {

enum class TraverseEnd : std::uint8_t {
  arrived,      ///< truly within the limit
  wrong_place,  ///< it believes to be there and is not
  collision,    ///< it touched something on the way
  no_plan,      ///< no route at the start
  late,         ///< it ran out of time, or got nowhere
};

struct Traverse {
  TraverseEnd end = TraverseEnd::late;
  double off_m = 0;     ///< from the true place, at the end
  double length_m = 0;  ///< of the first route
  double time_s = 0;    ///< until the end
  double allowed_s = 0;
  std::size_t replans = 0;
  std::size_t blocked = 0;  ///< times that the follower said so
  double plan_cpu_s = 0;    ///< largest of a plan, all that it needs included
  std::vector<Pose2> way;   ///< the true poses
};

struct TraverseOptions {
  double arrived_m = 0.30;     ///< from the true place
  double times_the_path = 3;   ///< what a traverse may take, in times that the path takes at the robot's limits
  double replan_every = 4;     ///< seconds
  double gives_up_after = 60;  ///< without getting anywhere: it is late as well, seconds
  double period = 0.1;         ///< of the simulation, seconds
  FollowerOptions follower;
};

/// Makes routes on the map as it is now; may keep what it needs from one to the next.
using Planner = std::function<ManifoldRoute(const Map&, const ManifoldPose& from, const ManifoldPoint& goal)>;

/// A planner on the manifold: by the map's own neighbours, with the snapshot of before.
[[nodiscard]] Planner manifold_planner();
/// A planner on one planar grid (planar_route.hpp).
[[nodiscard]] Planner planar_planner();

/// Drives robot 0 to where a scan was taken (goal), which truly is p_world_goal.
[[nodiscard]] Traverse retro_traverse(LiveMapping& mapping, const Planner& planner, const ManifoldPoint& goal,
                                      const Vector2d& p_world_goal, const TraverseOptions& options = {});

}  // namespace helicoid
