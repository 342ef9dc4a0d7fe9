#include "helicoid/navigation/kept_way.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kStep = 0.1;  // between places that are looked at, metres

/// All along the straight way between two points of a route.
bool has_room(const NavigableMap& map, const ManifoldPoint& from, const ManifoldPoint& to) {
  const std::vector<Pose2>& T_plane_patch = map.plan()->T_plane_patch;
  const Vector2d end = T_plane_patch[from.patch.index()].inverse() * map.project(to);
  const Vector2d way = end - from.p_patch;
  const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / kStep)));
  for (int k = 0; k <= steps; ++k) {
    const ManifoldPoint at{from.patch, from.p_patch + way * k / steps};
    if (map.clearance(at) < map.options().robot_radius || map.is_forbidden(at)) return false;
  }
  return true;
}

}  // namespace

bool only_leads_back(const NavigableMap& map, const ManifoldRoute& route, double left, const ManifoldRoute& found,
                     double longer) {
  if (found.length <= left + longer) return false;
  double seen = 0;
  for (std::size_t i = route.points.size(); i-- > 1 && seen < left;) {
    const ManifoldPoint& from = route.points[i - 1];
    const ManifoldPoint& to = route.points[i];
    if (!has_room(map, from, to)) return false;
    seen += (map.project(to) - map.project(from)).norm();
  }
  return true;
}

}  // namespace helicoid
