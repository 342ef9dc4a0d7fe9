#include "helicoid/exploration/frontiers.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "helicoid/exploration/goal_search.hpp"
#include "helicoid/exploration/look.hpp"

namespace helicoid {

namespace {

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

std::vector<GroundCell> edge_cells(const EdgeCluster& cluster) {
  // Half a cell inside the boundary: a cell's centre must lie inside to be free.
  std::set<GroundCell> cells;
  for (const EdgePoint& p : cluster.points) {
    for (const double inside : {0.05, 0.12}) cells.insert(ground_cell(p.p_plane - inside * p.outward_plane));
  }
  return {cells.begin(), cells.end()};
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

/// What lies about an edge, and what can be seen of it from there.
class EdgeSurroundings {
 public:
  EdgeSurroundings(const Map& map, const EdgeCluster& cluster, std::span<const PatchId> patches, GroundWindow floor,
                   const FrontierOptions& options)
      : map_(map),
        cluster_(cluster),
        patches_(patches),
        options_(options),
        cells_(edge_cells(cluster)),
        floor_(std::move(floor)),
        wide_(floor_),
        sight_(floor_) {
    wide_.mark_near_obstacles(static_cast<int>(options.robot_radius / kGroundCell));
    sight_.mark_near_obstacles(1);
  }

  [[nodiscard]] std::optional<ManifoldPoint> find_goal(std::span<const Travel> travel,
                                                       const GoalSearch::Suits& suits) const {
    std::optional<ManifoldPoint> goal = GoalSearch(map_, wide_, patches_, options_).find(cells_, travel, suits);
    // Who cannot get to an edge past what stands there, or has seen only a sliver along it, can look from before it.
    if (!goal) goal = GoalSearch(map_, floor_, patches_, options_).find(cells_, travel, suits);
    return goal;
  }
  [[nodiscard]] std::optional<ManifoldPoint> stand_near(std::span<const Travel> travel) const {
    return nearest_stand(map_, sight_, patches_, cluster_.middle_plane, travel, options_);
  }

  /// To look into what is not known, in the point's patch.
  [[nodiscard]] double heading(const ManifoldPoint& from) const {
    return wrap_angle(heading_to(cluster_, project(map_, from)) - map_.T_plane_patch(from.patch).yaw);
  }
  [[nodiscard]] Look look(const ManifoldPoint& from) const {
    const Vector2d from_plane = project(map_, from);
    return look_from(sight_, from_plane, heading_to(cluster_, from_plane), options_.field_of_view, options_.look_range);
  }
  void look_from_goal(const ManifoldPoint& goal, Frontier& frontier) const {
    Look seen = look(goal);
    frontier.goal = goal;
    frontier.heading_patch = heading(goal);
    frontier.gain_m2 = seen.gain_m2;
    frontier.seen = std::move(seen.seen);
  }

  /// No robot gets to where it sees what is there.
  void say_why_not(Frontier& frontier) const {
    std::vector<GroundCell> stood;
    stood.reserve(patches_.size());
    for (const PatchId id : patches_) stood.push_back(ground_cell(map_.T_plane_patch(id).translation()));
    frontier.opening = widest_opening(sight_, cells_, stood);
    frontier.is_narrow = frontier.opening < 2 * options_.robot_radius;
    frontier.status = frontier.is_narrow ? FrontierStatus::too_narrow : FrontierStatus::unreachable;
  }

 private:
  const Map& map_;
  const EdgeCluster& cluster_;
  std::span<const PatchId> patches_;
  const FrontierOptions& options_;
  std::vector<GroundCell> cells_;
  GroundWindow floor_, wide_, sight_;
};

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
  const EdgeSurroundings about(map, cluster, patches, window_about(map, cluster, patches), options_);
  if (const auto nearest = about.find_goal(travel, [](const ManifoldPoint&) { return true; })) {
    about.look_from_goal(*nearest, frontier);
    if (frontier.gain_m2 >= options_.least_gain) return frontier;
  }
  // The nearest place may be round a corner from what there is to see.
  Frontier from_edge = describe(map, cluster);
  about.look_from_goal(from_edge.middle, from_edge);
  if (from_edge.gain_m2 < options_.least_gain) return from_edge;
  const auto sees = [&](const ManifoldPoint& point) { return about.look(point).gain_m2 >= options_.least_gain; };
  if (const auto goal = about.find_goal(travel, sees)) {
    about.look_from_goal(*goal, from_edge);
    return from_edge;
  }
  about.say_why_not(from_edge);
  // What is seen to be narrow may be a door that was seen along its wall: one look from near tells.
  if (from_edge.gain_m2 < options_.least_gain_near) return from_edge;
  if (const auto near = about.stand_near(travel)) {
    from_edge.goal = *near;
    from_edge.heading_patch = about.heading(*near);
    from_edge.status = FrontierStatus::from_near;
  }
  return from_edge;
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
