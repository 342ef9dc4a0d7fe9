#include "helicoid/simulation/tour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "helicoid/simulation/drivable_grid.hpp"

namespace helicoid {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// The cheapest ways from one cell to all others (Dijkstra 1959); narrow places cost more.
struct Ways {
  std::vector<float> cost;
  std::vector<std::size_t> before;
};

Ways find_ways(const DrivableGrid& grid, std::size_t from, const TourOptions& options) {
  Ways ways{std::vector<float>(grid.clearance.size(), kFar), std::vector<std::size_t>(grid.clearance.size(), kNone)};
  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  ways.cost[from] = 0;
  queue.emplace(0.0F, from);
  while (!queue.empty()) {
    const auto [cost, at] = queue.top();
    queue.pop();
    if (cost > ways.cost[at]) continue;
    const auto column = static_cast<int>(at % static_cast<std::size_t>(grid.width));
    const auto row = static_cast<int>(at / static_cast<std::size_t>(grid.width));
    for (int dc = -1; dc <= 1; ++dc) {
      for (int dr = -1; dr <= 1; ++dr) {
        if ((dc == 0 && dr == 0) || !grid.drivable(column + dc, row + dr)) continue;
        const std::size_t next = grid.index(column + dc, row + dr);
        const double narrow = std::max(0.0, options.comfortable - static_cast<double>(grid.clearance[next]));
        const double length = grid.cell * std::hypot(dc, dr);
        const float then = cost + static_cast<float>(length * (1 + 4 * narrow));
        if (then >= ways.cost[next]) continue;
        ways.cost[next] = then;
        ways.before[next] = at;
        queue.emplace(then, next);
      }
    }
  }
  return ways;
}

/// Places that lie at least `spacing` apart and leave no floor farther than that from all of them; the first given.
std::vector<std::size_t> choose_places(const DrivableGrid& grid, std::size_t first, const TourOptions& options) {
  std::vector<std::size_t> places{first};
  std::vector<double> gap(grid.clearance.size(), std::numeric_limits<double>::infinity());
  while (places.size() < options.most_places) {
    std::size_t farthest = first;
    double widest = 0;
    for (std::size_t i = 0; i < gap.size(); ++i) {
      if (grid.clearance[i] <= 0) continue;
      gap[i] = std::min(gap[i], (grid.centre(i) - grid.centre(places.back())).norm());
      // Of places that are equally far, one in the open.
      const double worth = gap[i] + 0.5 * static_cast<double>(grid.clearance[i]);
      if (gap[i] < options.spacing || worth <= widest) continue;
      widest = worth;
      farthest = i;
    }
    if (widest == 0) break;
    places.push_back(farthest);
  }
  return places;
}

/// True if a robot can drive straight from a to b.
bool is_straight(const DrivableGrid& grid, const Vector2d& a, const Vector2d& b) {
  const auto steps = static_cast<int>(std::ceil(2 * (b - a).norm() / grid.cell));
  for (int k = 0; k <= steps; ++k) {
    const Vector2d p = (a + (static_cast<double>(k) / std::max(steps, 1)) * (b - a) - grid.origin) / grid.cell;
    if (!grid.drivable(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())))) return false;
  }
  return true;
}

/// Drops corners that a straight line can do without.
std::vector<Vector2d> straightened(const DrivableGrid& grid, const std::vector<Vector2d>& way) {
  std::vector<Vector2d> straight{way.front()};
  for (std::size_t at = 0; at + 1 < way.size();) {
    std::size_t next = at + 1;
    while (next + 1 < way.size() && is_straight(grid, way[at], way[next + 1])) ++next;
    straight.push_back(way[next]);
    at = next;
  }
  return straight;
}

void append_way(const DrivableGrid& grid, const Ways& ways, std::size_t to, std::vector<Vector2d>& points) {
  std::vector<Vector2d> way;
  for (std::size_t at = to; at != kNone; at = ways.before[at]) way.push_back(grid.centre(at));
  std::reverse(way.begin(), way.end());
  const std::vector<Vector2d> straight = straightened(grid, way);
  points.insert(points.end(), straight.begin() + (points.empty() ? 0 : 1), straight.end());
}

std::size_t first_place(const DrivableGrid& grid, const World& world) {
  std::size_t best = kNone;
  double worth = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < grid.clearance.size(); ++i) {
    if (grid.clearance[i] <= 0) continue;
    const double here = world.starts.empty() ? static_cast<double>(grid.clearance[i])
                                             : -(grid.centre(i) - world.starts[0].translation()).norm();
    if (here <= worth) continue;
    worth = here;
    best = i;
  }
  return best;
}

}  // namespace

Result<Route> plan_tour(const World& world, const TourOptions& options) {
  const Result<DrivableGrid> grid =
      make_drivable_grid(world, options.cell, options.clearance, options.comfortable, options.most_cells);
  if (!grid) return tl::unexpected(grid.error());
  const std::size_t first = first_place(*grid, world);
  if (first == kNone) return fail("{}: has no room for a robot; give it a route or a start", world.name);
  std::vector<std::size_t> places = choose_places(*grid, first, options);
  if (places.size() < 2) return fail("{}: is too small for a tour; give it a route", world.name);
  places.erase(places.begin());
  Route route{{}, true};
  std::size_t at = first;
  // Always on to the nearest place that is left, and home in the end.
  while (true) {
    const Ways ways = find_ways(*grid, at, options);
    if (places.empty()) {
      append_way(*grid, ways, first, route.points);
      break;
    }
    const auto next = std::min_element(places.begin(), places.end(),
                                       [&](std::size_t a, std::size_t b) { return ways.cost[a] < ways.cost[b]; });
    append_way(*grid, ways, *next, route.points);
    at = *next;
    places.erase(next);
  }
  route.points.pop_back();  // a closed route does not name its first point twice
  return route;
}

}  // namespace helicoid
