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

/// By place: closed for now, or forbidden.
std::vector<bool> closed_places(const NavigableMap& map, const FloorPlace& start, std::span<const ClosedFloor> closed) {
  const FloorPlan& plan = *map.plan();
  std::vector<bool> places = map.forbidden_from(start);
  if (!closed.empty()) places.resize(plan.place_count(), false);
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

std::optional<FloorPlace> stand_at(const FloorPlan& plan, const ManifoldPoint& point) {
  const std::optional<FloorPlace> place = plan.locate(point);
  return place ? standing_near(plan, *place, plan.options.reach) : std::nullopt;
}

/// The way of a search to a place that it reached, pulled taut, to a point (plane) in that place.
ManifoldRoute route_to(const NavigableMap& map, const ManifoldPose& from, const FloorSearch& search,
                       const FloorPlace& last, const Vector2d& to, const std::vector<bool>& closed) {
  const FloorPlan& plan = *map.plan();
  ManifoldRoute route;
  CellWay way{{}, to, search.way_to(last)};
  if (way.places.empty()) return route;
  way.from = plan.centre(way.places.front());
  route.status = RouteStatus::found;
  if (map.is_passable(point_of(from))) {
    way.from = map.project(point_of(from));
  } else {
    route.points.push_back(point_of(from));
  }
  for (const WayPoint& point : pull_taut(plan, way, closed, kSpacing)) route.points.push_back(on_patch(plan, point));
  route.length = length_of(plan, route.points);
  return route;
}

/// The squared distance of a point to a line of points.
double squared_distance(const Vector2d& p, std::span<const Vector2d> line) {
  double least = line.empty() ? std::numeric_limits<double>::infinity() : (line[0] - p).squaredNorm();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector2d along = line[i] - line[i - 1];
    const double length = along.squaredNorm();
    const double share = length > 0 ? std::clamp((p - line[i - 1]).dot(along) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (line[i - 1] + share * along - p).squaredNorm());
  }
  return least;
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
  const std::optional<FloorPlace> first = stand_at(plan, point_of(from));
  const std::optional<FloorPlace> last = stand_at(plan, goal);
  if (!first) return {RouteStatus::start_off_ground, {}, 0};
  if (!last) return {RouteStatus::goal_off_ground, {}, 0};
  const std::vector<bool> closed_now = closed_places(map, *first, closed);
  const Vector2d to = map.is_passable(goal) ? map.project(goal) : plan.centre(*last);
  return route_to(map, from, search_floor(plan, *first, last, closed_now), *last, to, closed_now);
}

ManifoldRoute plan_route_aside(const NavigableMap& map, const ManifoldPose& from, std::span<const ManifoldPoint> way,
                               std::span<const ClosedFloor> closed, const AsideOptions& options) {
  const FloorPlan& plan = *map.plan();
  const std::optional<FloorPlace> first = stand_at(plan, point_of(from));
  if (!first) return {RouteStatus::start_off_ground, {}, 0};
  std::vector<Vector2d> barred;
  for (const ManifoldPoint& point : way) barred.push_back(map.project(point));
  const std::vector<bool> closed_now = closed_places(map, *first, closed);
  const FloorSearch search = search_floor(plan, *first, std::nullopt, closed_now);
  std::optional<std::uint32_t> best;
  for (std::uint32_t k = 0; k < search.cost.size(); ++k) {
    if (search.length[k] > options.farthest || (best && search.cost[k] >= search.cost[*best])) continue;
    if (squared_distance(plan.centre(place_of(k)), barred) >= options.apart * options.apart) best = k;
  }
  if (!best) return {};
  return route_to(map, from, search, place_of(*best), plan.centre(place_of(*best)), closed_now);
}

}  // namespace helicoid
