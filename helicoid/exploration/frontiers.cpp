#include "helicoid/exploration/frontiers.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <set>

#include "helicoid/exploration/look.hpp"

namespace helicoid {

namespace {

/// A goal that cannot be reached is not tried again this near.
constexpr double kNextTry = 0.4;
constexpr std::size_t kMostTries = 12;

bool is_reachable(const ManifoldPoint& point, std::span<const Travel> travel) {
  return std::any_of(travel.begin(), travel.end(), [&](const Travel& t) { return std::isfinite(t(point)); });
}

/// The patches of a cluster and what is around them; ascending.
std::vector<PatchId> patches_about(const OpenEdges& edges, const EdgeCluster& cluster) {
  PatchSet set(edges.size());
  PatchId last;
  for (const EdgePoint& point : cluster.points) {
    if (point.patch == last) continue;
    last = point.patch;
    set |= edges.set_around(last);
  }
  std::vector<PatchId> patches;
  set.for_each([&](std::size_t i) { patches.push_back(make_id<PatchId>(i)); });
  return patches;
}

/// Of the numbers that a frontier is judged from (FNV-1a).
class Fingerprint {
 public:
  void add(std::uint64_t value) {
    for (int k = 0; k < 64; k += 8) hash_ = (hash_ ^ (value >> k & 0xFFU)) * 0x100000001B3U;
  }
  void add(double value, double step) { add(static_cast<std::uint64_t>(std::llround(value / step))); }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

std::uint64_t fingerprint_of_edge(const Map& map, const EdgeCluster& cluster) {
  Fingerprint print;
  const Pose2 T_patch_plane = map.T_plane_patch(cluster.points.front().patch).inverse();
  for (const EdgePoint& point : cluster.points) {
    const Vector2d p = T_patch_plane * point.p_plane;
    print.add(point.patch.value);
    print.add(p.x(), 0.1);
    print.add(p.y(), 0.1);
  }
  return print.value();
}

std::uint64_t fingerprint_of_patches(const Map& map, std::span<const PatchId> patches) {
  Fingerprint print;
  for (const PatchId id : patches) {
    print.add(id.value);
    print.add(map.T_plane_patch(id).x, 0.1);
    print.add(map.T_plane_patch(id).y, 0.1);
  }
  return print.value();
}

/// A place on the ground in the patch that knows it from nearest by.
std::optional<ManifoldPoint> on_patch(const Map& map, std::span<const PatchId> patches, const Vector2d& p_plane) {
  std::optional<ManifoldPoint> best;
  for (const PatchId id : patches) {
    const Vector2d p_patch = map.T_plane_patch(id).inverse() * p_plane;
    if (best && best->p_patch.norm() <= p_patch.norm()) continue;
    if (p_patch.norm() <= map.patch(id).free_reach && is_ground(map.patch(id), p_patch)) best = {id, p_patch};
  }
  return best;
}

std::vector<GroundCell> edge_cells(const EdgeCluster& cluster) {
  // Half a cell inside the boundary: a cell's centre must lie inside to be free.
  std::set<GroundCell> cells;
  for (const EdgePoint& p : cluster.points) {
    for (const double inside : {0.05, 0.12}) cells.insert(ground_cell(p.p_plane - inside * p.outward_plane));
  }
  return {cells.begin(), cells.end()};
}

/// The nearest place to the edge, by the way over known floor, that a robot can stand on and go to.
class GoalSearch {
 public:
  GoalSearch(const Map& map, const GroundWindow& window, std::span<const PatchId> patches,
             const FrontierOptions& options)
      : map_(map), window_(window), patches_(patches), options_(options), way_(window.cells(), -1) {}

  std::optional<ManifoldPoint> find(std::span<const GroundCell> edge, std::span<const Travel> travel) {
    for (const GroundCell& cell : edge) push(cell, 0, true);
    const double room = (options_.robot_radius + options_.margin) / kGroundCell;
    while (!open_.empty() && tried_.size() < kMostTries) {
      const GroundCell cell = open_.front();
      open_.pop_front();
      const int way = way_[window_.index(cell)];
      if (way * kGroundCell > options_.goal_reach) break;
      if (window_.has_room(cell, room) && is_new_try(cell)) {
        std::optional<ManifoldPoint> point = on_patch(map_, patches_, centre_of(cell));
        if (point && is_reachable(*point, travel)) return point;
        tried_.push_back(cell);
      }
      push({cell.row + 1, cell.column}, way + 1, false);
      push({cell.row - 1, cell.column}, way + 1, false);
      push({cell.row, cell.column + 1}, way + 1, false);
      push({cell.row, cell.column - 1}, way + 1, false);
    }
    return std::nullopt;
  }

 private:
  void push(const GroundCell& cell, int way, bool is_edge) {
    if (!window_.holds(cell) || !window_.is_free(cell) || way_[window_.index(cell)] >= 0) return;
    // What is too near to an obstacle for the robot's middle is no way to the edge.
    if (!is_edge && window_.is_near_obstacle(cell)) return;
    way_[window_.index(cell)] = way;
    open_.push_back(cell);
  }
  [[nodiscard]] bool is_new_try(const GroundCell& cell) const {
    return std::none_of(tried_.begin(), tried_.end(), [&](const GroundCell& t) {
      return std::hypot(t.row - cell.row, t.column - cell.column) * kGroundCell < kNextTry;
    });
  }

  const Map& map_;
  const GroundWindow& window_;
  std::span<const PatchId> patches_;
  const FrontierOptions& options_;
  std::vector<int> way_;
  std::deque<GroundCell> open_;
  std::vector<GroundCell> tried_;
};

/// The nearest place to a point (plane), as the crow flies, that a robot can stand on and go to.
std::optional<ManifoldPoint> nearest_stand(const Map& map, const GroundWindow& window, std::span<const PatchId> patches,
                                           const Vector2d& p_plane, std::span<const Travel> travel,
                                           const FrontierOptions& options) {
  const GroundCell middle = ground_cell(p_plane);
  const double room = (options.robot_radius + options.margin) / kGroundCell;
  const int step = static_cast<int>(kNextTry / kGroundCell);
  const int reach = static_cast<int>(options.near / kGroundCell);
  std::optional<ManifoldPoint> best;
  double least = options.near;
  for (int row = -reach; row <= reach; row += step) {
    for (int column = -reach; column <= reach; column += step) {
      const double away = kGroundCell * std::hypot(row, column);
      const GroundCell cell{middle.row + row, middle.column + column};
      if (away >= least || !window.holds(cell) || !window.is_free(cell) || !window.has_room(cell, room)) continue;
      const std::optional<ManifoldPoint> point = on_patch(map, patches, centre_of(cell));
      if (!point || !is_reachable(*point, travel)) continue;
      best = point;
      least = away;
    }
  }
  return best;
}

/// The edge as seen from the patch that holds most of it.
Frontier describe(const Map& map, const EdgeCluster& cluster) {
  Frontier frontier;
  frontier.island = cluster.island;
  frontier.length = cluster.length;
  const auto nearest =
      std::min_element(cluster.points.begin(), cluster.points.end(), [&](const auto& a, const auto& b) {
        return (a.p_plane - cluster.middle_plane).squaredNorm() < (b.p_plane - cluster.middle_plane).squaredNorm();
      });
  const Pose2 T_patch_plane = map.T_plane_patch(nearest->patch).inverse();
  frontier.middle = {nearest->patch, T_patch_plane * nearest->p_plane};
  frontier.goal = frontier.middle;
  for (const EdgePoint& point : cluster.points) frontier.edge_patch.push_back(T_patch_plane * point.p_plane);
  return frontier;
}

/// From the goal over the edge, into what is not known.
double heading_to(const EdgeCluster& cluster, const Vector2d& goal_plane) {
  const Vector2d way = cluster.middle_plane + 0.5 * cluster.outward_plane - goal_plane;
  return std::atan2(way.y(), way.x());
}

}  // namespace

const char* name_of(FrontierStatus status) {
  switch (status) {
    case FrontierStatus::open: return "open";
    case FrontierStatus::from_near: return "from near";
    case FrontierStatus::too_narrow: return "too narrow";
    case FrontierStatus::unreachable: break;
  }
  return "unreachable";
}

GroundWindow FrontierFinder::window_about(const Map& map, const EdgeCluster& cluster,
                                          std::span<const PatchId> patches) {
  const double half = std::max(options_.look_range, options_.goal_reach) + 1;
  GroundWindow window(ground_cell(cluster.middle_plane), static_cast<int>(half / kGroundCell));
  for (const PatchId id : patches) window.add(cells_.of(edges_.view(id), map.T_plane_patch(id)));
  return window;
}

Frontier FrontierFinder::judge(const Map& map, const EdgeCluster& cluster, std::span<const PatchId> patches,
                               std::span<const Travel> travel) {
  Frontier frontier = describe(map, cluster);
  const std::vector<GroundCell> edge = edge_cells(cluster);
  GroundWindow window = window_about(map, cluster, patches);
  GroundWindow wide = window;
  wide.mark_near_obstacles(static_cast<int>(options_.robot_radius / kGroundCell));
  std::optional<ManifoldPoint> goal = GoalSearch(map, wide, patches, options_).find(edge, travel);
  // Who cannot get to an edge past what stands there, or has seen only a sliver along it, can look from before it.
  if (!goal) goal = GoalSearch(map, window, patches, options_).find(edge, travel);
  if (goal) frontier.goal = *goal;
  const Vector2d from_plane = project(map, frontier.goal);
  const double heading = heading_to(cluster, from_plane);
  window.mark_near_obstacles(1);
  Look look = look_from(window, from_plane, heading, options_.field_of_view, options_.look_range);
  frontier.heading_patch = wrap_angle(heading - map.T_plane_patch(frontier.goal.patch).yaw);
  frontier.gain_m2 = look.gain_m2;
  frontier.seen = std::move(look.seen);
  if (goal || frontier.gain_m2 < options_.least_gain) return frontier;
  std::vector<GroundCell> stood;
  stood.reserve(patches.size());
  for (const PatchId id : patches) stood.push_back(ground_cell(map.T_plane_patch(id).translation()));
  frontier.opening = widest_opening(window, edge, stood);
  frontier.is_narrow = frontier.opening < 2 * options_.robot_radius;
  frontier.status = frontier.is_narrow ? FrontierStatus::too_narrow : FrontierStatus::unreachable;
  if (frontier.gain_m2 < options_.least_gain_near) return frontier;
  if (const auto near = nearest_stand(map, window, patches, cluster.middle_plane, travel, options_)) {
    frontier.goal = *near;
    frontier.heading_patch = wrap_angle(heading_to(cluster, project(map, *near)) - map.T_plane_patch(near->patch).yaw);
    frontier.status = FrontierStatus::from_near;
  }
  return frontier;
}

std::vector<Frontier> FrontierFinder::find(const Map& map, const Neighbours& neighbours,
                                           std::span<const Travel> travel) {
  edges_.update(map, neighbours);
  std::vector<Frontier> frontiers;
  std::map<std::uint64_t, Judged> judged;
  for (const EdgeCluster& cluster : cluster_edges(map, edges_, options_.clusters)) {
    const std::vector<PatchId> patches = patches_about(edges_, cluster);
    const std::uint64_t edge = fingerprint_of_edge(map, cluster);
    Judged& now = judged[edge];
    const auto before = judged_.find(edge);
    const std::uint64_t print = fingerprint_of_patches(map, patches);
    if (before != judged_.end() && holds(before->second, print, travel)) {
      now = std::move(before->second);
      ++now.age;
    } else {
      now = {judge(map, cluster, patches, travel), print, 0};
    }
    if (now.frontier.gain_m2 >= options_.least_gain) frontiers.push_back(now.frontier);
  }
  judged_ = std::move(judged);
  return frontiers;
}

bool FrontierFinder::holds(const Judged& before, std::uint64_t patches, std::span<const Travel> travel) const {
  if (before.patches != patches && before.age >= options_.renewal) return false;
  // What could not be reached then may be now, by a way that leads elsewhere.
  return is_to_be_looked_at(before.frontier) == is_reachable(before.frontier.goal, travel);
}

std::vector<Frontier> find_frontiers(const Map& map, const Neighbours& neighbours, std::span<const Travel> travel,
                                     const FrontierOptions& options) {
  return FrontierFinder(options).find(map, neighbours, travel);
}

double shared_gain(const Frontier& a, const Frontier& b) {
  if (a.island != b.island) return 0;
  double shared = 0;
  for (std::size_t i = 0, k = 0; i < a.seen.size() && k < b.seen.size();) {
    const auto at_a = std::pair(a.seen[i].row, a.seen[i].column);
    const auto at_b = std::pair(b.seen[k].row, b.seen[k].column);
    if (at_a == at_b) shared += std::min(a.seen[i].area, b.seen[k].area);
    if (at_a <= at_b) ++i;
    if (at_b <= at_a) ++k;
  }
  return shared;
}

}  // namespace helicoid
