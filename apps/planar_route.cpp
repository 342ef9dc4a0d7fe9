#include "apps/planar_route.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>

#include "helicoid/charts/occupancy_grid.hpp"

namespace helicoid {

namespace {

constexpr double kResolution = 0.05;  // metres
constexpr double kCornerSpacing = 1.0;
constexpr std::size_t kFailures = 20;  // in a row, of straight lines to farther cells

}  // namespace

/// The floor of the grid: how far each cell's centre is from the next that is not free, metres.
class PlanarFloor {
 public:
  PlanarFloor(const Map& map, std::span<const PatchId> patches, const NavigationOptions& options)
      : frame_(frame_around(map, patches, {kResolution, 0.5, 64'000'000})), options_(options) {
    const std::vector<CellState> states = classify(draw_occupancy(map, patches, frame_));
    clearance_.assign(frame_.size(), static_cast<float>(options.comfortable));
    const int reach = static_cast<int>(options.comfortable / frame_.resolution);
    for (int row = 0; row < frame_.height; ++row) {
      for (int column = 0; column < frame_.width; ++column) {
        if (states[frame_.index(column, row)] == CellState::free) continue;
        if (has_free_beside(states, column, row)) inflate(column, row, reach);
        clearance_[frame_.index(column, row)] = 0;
      }
    }
  }

  [[nodiscard]] const GridFrame& frame() const { return frame_; }
  /// Up to what is comfortable, metres.
  [[nodiscard]] double clearance(std::size_t cell) const { return static_cast<double>(clearance_[cell]); }
  [[nodiscard]] bool passable(std::size_t cell) const { return clearance(cell) >= least_clearance(); }
  /// From a cell's centre to the centre of one that is not free: the surface may lie nearer by half a cell.
  [[nodiscard]] double least_clearance() const { return options_.least_clearance() + 0.5 * frame_.resolution; }
  [[nodiscard]] std::optional<std::size_t> cell(const Vector2d& p) const {
    const Vector2d at = frame_.to_cells(p);
    const int column = static_cast<int>(std::floor(at.x()));
    const int row = static_cast<int>(std::floor(at.y()));
    if (!frame_.inside(column, row)) return std::nullopt;
    return frame_.index(column, row);
  }
  /// The nearest passable cell within the reach; straight.
  [[nodiscard]] std::optional<std::size_t> standing(const Vector2d& p) const {
    std::optional<std::size_t> best;
    double nearest = options_.reach;
    const int reach = static_cast<int>(std::ceil(options_.reach / frame_.resolution));
    const Vector2d at = frame_.to_cells(p);
    for (int dr = -reach; dr <= reach; ++dr) {
      for (int dc = -reach; dc <= reach; ++dc) {
        const int column = static_cast<int>(std::floor(at.x())) + dc;
        const int row = static_cast<int>(std::floor(at.y())) + dr;
        if (!frame_.inside(column, row) || !passable(frame_.index(column, row))) continue;
        const double distance = (frame_.centre(column, row) - p).norm();
        if (distance >= nearest) continue;
        nearest = distance;
        best = frame_.index(column, row);
      }
    }
    return best;
  }
  [[nodiscard]] Vector2d centre(std::size_t cell) const {
    const auto width = static_cast<std::size_t>(frame_.width);
    return frame_.centre(static_cast<int>(cell % width), static_cast<int>(cell / width));
  }
  [[nodiscard]] bool is_straight_free(const Vector2d& from, const Vector2d& to, double room) const {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / (0.5 * frame_.resolution))));
    for (int k = 0; k <= steps; ++k) {
      const std::optional<std::size_t> at = cell(from + (to - from) * k / steps);
      if (!at || !passable(*at) || clearance(*at) < room) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] bool has_free_beside(const std::vector<CellState>& states, int column, int row) const {
    for (int k = 0; k < 9; ++k) {
      const int c = column + k % 3 - 1;
      const int r = row + k / 3 - 1;
      if (frame_.inside(c, r) && states[frame_.index(c, r)] == CellState::free) return true;
    }
    return false;
  }
  void inflate(int column, int row, int reach) {
    for (int dr = -reach; dr <= reach; ++dr) {
      for (int dc = -reach; dc <= reach; ++dc) {
        if (!frame_.inside(column + dc, row + dr)) continue;
        float& at = clearance_[frame_.index(column + dc, row + dr)];
        at = std::min(at, static_cast<float>(frame_.resolution * std::hypot(dc, dr)));
      }
    }
  }

  GridFrame frame_;
  NavigationOptions options_;
  std::vector<float> clearance_;
};

namespace {

/// A* (Hart, Nilsson and Raphael 1968) over passable cells; empty if there is no way.
std::vector<Vector2d> shortest_way(const PlanarFloor& floor, std::size_t start, std::size_t goal) {
  const GridFrame& frame = floor.frame();
  const auto width = static_cast<std::size_t>(frame.width);
  const Vector2d to = floor.centre(goal);
  const auto guess = [&](std::size_t cell) { return static_cast<float>((floor.centre(cell) - to).norm()); };
  std::vector<float> cost(frame.size(), std::numeric_limits<float>::infinity());
  std::vector<std::size_t> parent(frame.size(), start);
  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  cost[start] = 0;
  queue.push({guess(start), start});
  while (!queue.empty() && queue.top().second != goal) {
    const auto [bound, at] = queue.top();
    queue.pop();
    if (bound > cost[at] + guess(at) + 1e-4F) continue;
    for (int k = 0; k < 9; ++k) {
      const int column = static_cast<int>(at % width) + k % 3 - 1;
      const int row = static_cast<int>(at / width) + k / 3 - 1;
      if (k == 4 || !frame.inside(column, row) || !floor.passable(frame.index(column, row))) continue;
      const std::size_t next = frame.index(column, row);
      const float reached = cost[at] + static_cast<float>(frame.resolution * (k % 2 == 0 ? std::numbers::sqrt2 : 1.0));
      if (reached >= cost[next]) continue;
      cost[next] = reached;
      parent[next] = at;
      queue.push({reached + guess(next), next});
    }
  }
  std::vector<Vector2d> way;
  if (!std::isfinite(cost[goal])) return way;
  for (std::size_t at = goal; at != start; at = parent[at]) way.push_back(floor.centre(at));
  way.push_back(floor.centre(start));
  std::reverse(way.begin(), way.end());
  return way;
}

/// As taut as the clearance that the way has allows.
std::vector<Vector2d> pull_taut(const PlanarFloor& floor, const std::vector<Vector2d>& way) {
  const auto room = [&](std::size_t i) {
    const std::optional<std::size_t> cell = floor.cell(way[i]);
    return cell ? floor.clearance(*cell) : 0.0;
  };
  std::vector<Vector2d> taut{way.front()};
  for (std::size_t i = 0; i + 1 < way.size();) {
    std::size_t farthest = i + 1;
    double least = std::min(room(i), room(i + 1));
    for (std::size_t j = i + 2; j < std::min(way.size(), farthest + kFailures); ++j) {
      least = std::min(least, room(j));
      if (floor.is_straight_free(way[i], way[j], least - 0.5 * kResolution)) farthest = j;
    }
    const int pieces = std::max(1, static_cast<int>(std::ceil((way[farthest] - way[i]).norm() / kCornerSpacing)));
    for (int k = 1; k <= pieces; ++k) taut.emplace_back(way[i] + (way[farthest] - way[i]) * k / pieces);
    i = farthest;
  }
  return taut;
}

}  // namespace

PlanarPlanner::PlanarPlanner(const NavigationOptions& options) : options_(options) {}
PlanarPlanner::~PlanarPlanner() = default;
PlanarPlanner::PlanarPlanner(PlanarPlanner&&) noexcept = default;
PlanarPlanner& PlanarPlanner::operator=(PlanarPlanner&&) noexcept = default;

/// Drawn anew when any pose has changed.
const PlanarFloor& PlanarPlanner::floor_of(const Map& map, IslandId island) {
  std::vector<Pose2> poses(map.poses().begin(), map.poses().end());
  if (floor_ && poses == poses_ && island == island_) return *floor_;
  poses_ = std::move(poses);
  island_ = island;
  patches_.clear();
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    if (map.island_of(make_id<PatchId>(i)) == island) patches_.push_back(make_id<PatchId>(i));
  }
  floor_ = std::make_unique<PlanarFloor>(map, patches_, options_);
  return *floor_;
}

ManifoldRoute PlanarPlanner::plan(const Map& map, const ManifoldPose& from, const ManifoldPoint& goal) {
  ManifoldRoute route;
  const IslandId island = map.island_of(from.patch);
  if (map.island_of(goal.patch) != island) return route;
  const PlanarFloor& floor = floor_of(map, island);
  const Vector2d p_from = map.project(from).translation();
  const Vector2d p_goal = project(map, goal);
  const std::optional<std::size_t> start = floor.standing(p_from);
  const std::optional<std::size_t> end = floor.standing(p_goal);
  if (!start || !end) {
    route.status = !start ? RouteStatus::start_off_ground : RouteStatus::goal_off_ground;
    return route;
  }
  const std::vector<Vector2d> way = shortest_way(floor, *start, *end);
  if (way.empty()) return route;
  route.status = RouteStatus::found;
  std::vector<Vector2d> points = pull_taut(floor, way);
  points.insert(points.begin(), p_from);
  if (floor.is_straight_free(points.back(), p_goal, 0)) points.push_back(p_goal);
  const Pose2 T_patch_plane = map.T_plane_patch(patches_.front()).inverse();
  for (std::size_t i = 0; i < points.size(); ++i) {
    route.points.push_back({patches_.front(), T_patch_plane * points[i]});
    if (i > 0) route.length += (points[i] - points[i - 1]).norm();
  }
  return route;
}

}  // namespace helicoid
