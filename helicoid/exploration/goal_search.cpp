#include "helicoid/exploration/goal_search.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// A place that does not suit, or that nobody gets to, is not tried again this near.
constexpr double kNextTry = 0.4;
/// So many that nobody gets to are tried, and so many that do not suit.
constexpr int kMostUnreachable = 12;
constexpr int kMostUnsuited = 24;

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

}  // namespace

bool is_reachable(const ManifoldPoint& point, std::span<const Travel> travel) {
  return std::any_of(travel.begin(), travel.end(), [&](const Travel& t) { return std::isfinite(t(point)); });
}

std::optional<ManifoldPoint> GoalSearch::find(std::span<const GroundCell> edge, std::span<const Travel> travel,
                                              const Suits& suits) {
  for (const GroundCell& cell : edge) push(cell, 0, true);
  const double room = (options_.robot_radius + options_.margin) / kGroundCell;
  int unreachable = 0;
  int unsuited = 0;
  while (!open_.empty() && unreachable < kMostUnreachable && unsuited < kMostUnsuited) {
    const GroundCell cell = open_.front();
    open_.pop_front();
    const int way = way_[window_.index(cell)];
    if (way * kGroundCell > options_.goal_reach) break;
    if (window_.has_room(cell, room) && is_new_try(cell)) {
      std::optional<ManifoldPoint> point = on_patch(map_, patches_, centre_of(cell));
      const bool has_way = point && is_reachable(*point, travel);
      if (has_way && suits(*point)) return point;
      ++(has_way ? unsuited : unreachable);
      tried_.push_back(cell);
    }
    push({cell.row + 1, cell.column}, way + 1, false);
    push({cell.row - 1, cell.column}, way + 1, false);
    push({cell.row, cell.column + 1}, way + 1, false);
    push({cell.row, cell.column - 1}, way + 1, false);
  }
  return std::nullopt;
}

void GoalSearch::push(const GroundCell& cell, int way, bool is_edge) {
  if (!window_.holds(cell) || !window_.is_free(cell) || way_[window_.index(cell)] >= 0) return;
  // What is too near to an obstacle for the robot's middle is no way to the edge.
  if (!is_edge && window_.is_near_obstacle(cell)) return;
  way_[window_.index(cell)] = way;
  open_.push_back(cell);
}

bool GoalSearch::is_new_try(const GroundCell& cell) const {
  return std::none_of(tried_.begin(), tried_.end(), [&](const GroundCell& t) {
    return std::hypot(t.row - cell.row, t.column - cell.column) * kGroundCell < kNextTry;
  });
}

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

}  // namespace helicoid
