// Routes on the manifold (design 5.7): from patch to neighbouring patch, taut, clear of all that could be touched.
#pragma once

#include <span>
#include <vector>

#include "helicoid/navigation/navigable_map.hpp"

namespace helicoid {

enum class RouteStatus : std::uint8_t {
  found,
  unreachable,       ///< no way that is wide enough leads there
  start_off_ground,  ///< the robot does not stand on floor that the map knows
  goal_off_ground,   ///< nor does the goal lie near any
};
[[nodiscard]] const char* name_of(RouteStatus status);

/// Each point on the patch nearest to it: what a fit does to the map elsewhere moves no part of the route.
struct ManifoldRoute {
  RouteStatus status = RouteStatus::unreachable;
  /// From where the robot stands to the goal (or the nearest floor to it, within NavigationOptions::reach); at most a
  /// metre apart, so that each stretch lies within one neighbourhood.
  std::vector<ManifoldPoint> points;
  double length = 0;  ///< metres
};

/// Floor that is closed for now: something stands there that the map does not know.
struct ClosedFloor {
  ManifoldPoint centre;
  double radius = 0.5;  ///< metres
};

/// The route of least cost, where a metre costs more the less room there is (NavigationOptions::discomfort), pulled
/// taut. All of it keeps the least clearance but the first and the last few decimetres if the robot or the goal stand
/// nearer to something than that; those lead straight away from it. Where a robot has been, what room it had will do.
[[nodiscard]] ManifoldRoute plan_route(const NavigableMap& map, const ManifoldPose& from, const ManifoldPoint& goal,
                                       std::span<const ClosedFloor> closed = {});

struct AsideOptions {
  double apart = 0.6;    ///< from the other's way: two radii, both margins and a little, metres
  double farthest = 15;  ///< metres that a robot goes to let another one pass
};

/// The route to the nearest place from which a robot bars nothing of another one's way (as routes have it).
/// Unreachable: there is none, or only through what is closed, as where the other one stands.
[[nodiscard]] ManifoldRoute plan_route_aside(const NavigableMap& map, const ManifoldPose& from,
                                             std::span<const ManifoldPoint> way,
                                             std::span<const ClosedFloor> closed = {},
                                             const AsideOptions& options = {});

}  // namespace helicoid
