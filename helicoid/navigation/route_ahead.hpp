// What of a route lies ahead of a robot, in the robot's own frame.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "helicoid/navigation/manifold_point.hpp"

namespace helicoid {

/// How far along a route a robot has come: the stretch that it is on.
struct RouteCursor {
  std::size_t stretch = 0;  ///< from point `stretch` to the next
};

struct RouteAhead {
  std::vector<Vector2d> way;  ///< from the place on the route nearest to the robot on, robot's frame, metres
  double left = 0;            ///< of the whole route, metres
  double aside = 0;           ///< from the robot to the route, metres
  RouteCursor cursor;
};

/// `reach` metres of it. By the poses of patches about the robot alone, relative to one another; the length that is
/// left by all of them.
[[nodiscard]] RouteAhead route_ahead(const Map& map, std::span<const ManifoldPoint> points, const ManifoldPose& robot,
                                     const RouteCursor& cursor, double reach);

/// The point so far along a way (its end, if it is shorter), and how far that is.
struct PointAlong {
  Vector2d p = Vector2d::Zero();
  double along = 0;
};
[[nodiscard]] PointAlong point_along(std::span<const Vector2d> way, double along);

}  // namespace helicoid
