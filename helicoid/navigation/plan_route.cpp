#include "helicoid/navigation/plan_route.hpp"

#include <algorithm>
#include <limits>

#include "helicoid/navigation/floor_search.hpp"
#include "helicoid/navigation/taut_way.hpp"

namespace helicoid {

namespace {

constexpr double kSpacing = 1.0;  // metres

/// The patch of the tile that stands nearest to the point among those that saw it free, or among all.
PatchId patch_for(const FloorPlan& plan, const WayPoint& point) {
  const FloorTile& tile = *plan.tiles[point.tile];
  const Vector2d p = point.p_plane - tile.block.halo_corner();
  const auto column = static_cast<unsigned>(std::clamp(cell_of(p.x()), 0, kTileCells - 1));
  const auto row = static_cast<std::size_t>(std::clamp(cell_of(p.y()), 0, kTileCells - 1));
  PatchId best;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < tile.patches.size(); ++i) {
    const bool saw = (tile.rasters[i]->part(tile.block)->free[row] >> column & 1U) != 0;
    const double distance =
        (plan.T_plane_patch[tile.patches[i].index()].translation() - point.p_plane).norm() + (saw ? 0 : 1e3);
    if (distance >= nearest) continue;
    nearest = distance;
    best = tile.patches[i];
  }
  return best;
}

ManifoldPoint on_patch(const FloorPlan& plan, const WayPoint& point) {
  const PatchId patch = patch_for(plan, point);
  return {patch, plan.T_plane_patch[patch.index()].inverse() * point.p_plane};
}

/// By place: closed for now.
std::vector<bool> closed_places(const FloorPlan& plan, std::span<const ClosedFloor> closed) {
  std::vector<bool> places(closed.empty() ? 0 : plan.place_count(), false);
  for (const ClosedFloor& floor : closed) {
    const std::optional<FloorPlace> at = plan.locate(floor.centre);
    if (!at) continue;
    const Vector2d centre = plan.T_plane_patch[floor.centre.patch.index()] * floor.centre.p_patch;
    std::vector<std::uint32_t> tiles{at->tile};
    for (const auto& beside : plan.beside[at->tile]) tiles.insert(tiles.end(), beside.begin(), beside.end());
    for (const std::uint32_t tile : tiles) {
      for (std::uint32_t k = 0; k < kPlacesOfTile; ++k) {
        const std::uint32_t number = tile * kPlacesOfTile + k;
        if ((plan.centre(place_of(number)) - centre).norm() <= floor.radius) places[number] = true;
      }
    }
  }
  return places;
}

double length_of(const FloorPlan& plan, std::span<const ManifoldPoint> points) {
  const auto project = [&](const ManifoldPoint& p) { return plan.T_plane_patch[p.patch.index()] * p.p_patch; };
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (project(points[i]) - project(points[i - 1])).norm();
  return length;
}

}  // namespace

const char* name_of(RouteStatus status) {
  switch (status) {
    case RouteStatus::found: return "found";
    case RouteStatus::unreachable: return "unreachable";
    case RouteStatus::start_off_ground: return "start off ground";
    case RouteStatus::goal_off_ground: return "goal off ground";
  }
  return "?";
}

ManifoldRoute plan_route(const NavigableMap& map, const ManifoldPose& from, const ManifoldPoint& goal,
                         std::span<const ClosedFloor> closed) {
  const FloorPlan& plan = *map.plan();
  const auto stand = [&](const ManifoldPoint& point) {
    const std::optional<FloorPlace> place = plan.locate(point);
    return place ? standing_near(plan, *place, plan.options.reach) : std::nullopt;
  };
  ManifoldRoute route;
  const std::optional<FloorPlace> first = stand(point_of(from));
  const std::optional<FloorPlace> last = stand(goal);
  if (!first || !last) {
    route.status = !first ? RouteStatus::start_off_ground : RouteStatus::goal_off_ground;
    return route;
  }
  const std::vector<bool> closed_now = closed_places(plan, closed);
  CellWay way{plan.centre(*first), plan.centre(*last), search_floor(plan, *first, last, closed_now).way_to(*last)};
  if (way.places.empty()) return route;
  route.status = RouteStatus::found;
  if (map.is_passable(point_of(from))) {
    way.from = map.project(point_of(from));
  } else {
    route.points.push_back(point_of(from));
  }
  if (map.is_passable(goal)) way.to = map.project(goal);
  for (const WayPoint& point : pull_taut(plan, way, closed_now, kSpacing))
    route.points.push_back(on_patch(plan, point));
  route.length = length_of(plan, route.points);
  return route;
}

}  // namespace helicoid
