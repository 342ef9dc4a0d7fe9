#include "helicoid/navigation/route_ahead.hpp"

#include <algorithm>
#include <limits>

namespace helicoid {

namespace {

/// A robot is looked for this far along the route from where it was, metres.
constexpr double kWindow = 1.5;

Vector2d nearest_on(const Vector2d& from, const Vector2d& to) {
  const Vector2d way = to - from;
  const double squared = way.squaredNorm();
  const double share = squared > 0 ? std::clamp(-from.dot(way) / squared, 0.0, 1.0) : 0.0;
  return from + share * way;
}

}  // namespace

RouteAhead route_ahead(const Map& map, std::span<const ManifoldPoint> points, const ManifoldPose& robot,
                       const RouteCursor& cursor, double reach) {
  RouteAhead ahead;
  if (points.empty()) return ahead;
  const Pose2 T_robot_plane = map.project(robot).inverse();
  const auto in_robot = [&](std::size_t i) -> Vector2d { return T_robot_plane * project(map, points[i]); };
  const std::size_t last = points.size() - 1;
  ahead.cursor = cursor;
  Vector2d here = in_robot(std::min(cursor.stretch, last));
  ahead.aside = here.norm();
  // The nearest place from the last one on; farther on only what is clearly nearer, where a route turns back.
  double along = 0;
  for (std::size_t i = cursor.stretch; i < last && along < kWindow; ++i) {
    const Vector2d from = in_robot(i);
    const Vector2d to = in_robot(i + 1);
    const Vector2d p = nearest_on(from, to);
    if (p.norm() < ahead.aside - 0.01 || i == cursor.stretch) {
      ahead.aside = p.norm();
      ahead.cursor.stretch = i;
      here = p;
    }
    along += (to - from).norm();
  }
  ahead.way.push_back(here);
  for (std::size_t i = ahead.cursor.stretch + 1; i <= last; ++i) {
    const Vector2d p = in_robot(i);
    const double step = (p - (i == ahead.cursor.stretch + 1 ? here : in_robot(i - 1))).norm();
    if (ahead.left < reach) ahead.way.push_back(p);
    ahead.left += step;
  }
  return ahead;
}

PointAlong point_along(std::span<const Vector2d> way, double along) {
  double before = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double length = (way[i] - way[i - 1]).norm();
    if (before + length >= along && length > 0) {
      return {way[i - 1] + (along - before) / length * (way[i] - way[i - 1]), along};
    }
    before += length;
  }
  return {way.empty() ? Vector2d(0, 0) : way.back(), before};
}

}  // namespace helicoid
