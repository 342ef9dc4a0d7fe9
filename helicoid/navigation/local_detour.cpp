#include "helicoid/navigation/local_detour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

namespace helicoid {

namespace {

constexpr double kCell = 0.06;
constexpr int kSide = 96;
constexpr double kBehind = 1.2;                 // of the window, metres
constexpr double kAside = 0.5 * kSide * kCell;  // metres
constexpr double kTightness = 1.5;              // by what a metre with the least room costs more, as a share
constexpr float kUnreachable = std::numeric_limits<float>::infinity();
constexpr double kNoTouch = 1.0;  // metres

struct Cell {
  int column = 0, row = 0;
  [[nodiscard]] bool is_inside() const { return column >= 0 && row >= 0 && column < kSide && row < kSide; }
  [[nodiscard]] std::size_t index() const {
    return static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column);
  }
  [[nodiscard]] Vector2d centre() const { return {(column + 0.5) * kCell - kBehind, (row + 0.5) * kCell - kAside}; }
};
Cell cell_at(const Vector2d& p) {
  return {static_cast<int>(std::floor((p.x() + kBehind) / kCell)),
          static_cast<int>(std::floor((p.y() + kAside) / kCell))};
}
Cell cell_of_index(std::size_t index) {
  return {static_cast<int>(index % kSide), static_cast<int>(index / kSide)};
}

/// Distances to obstacles, by cell, up to `reach`.
std::vector<float> clearances(const LiveObstacles& obstacles, double reach) {
  std::vector<float> squared(static_cast<std::size_t>(kSide) * kSide, static_cast<float>(kNoTouch * kNoTouch));
  const int cells = static_cast<int>(std::ceil(reach / kCell));
  for (const Vector2d& p : obstacles.points()) {
    const Cell middle = cell_at(p);
    for (int row = std::max(0, middle.row - cells); row <= std::min(kSide - 1, middle.row + cells); ++row) {
      for (int column = std::max(0, middle.column - cells); column <= std::min(kSide - 1, middle.column + cells);
           ++column) {
        const Cell cell{column, row};
        float& at = squared[cell.index()];
        at = std::min(at, static_cast<float>((cell.centre() - p).squaredNorm()));
      }
    }
  }
  for (float& at : squared) at = std::sqrt(at);
  return squared;
}

/// Points every few centimetres of the route.
std::vector<Vector2d> sampled(std::span<const Vector2d> route) {
  std::vector<Vector2d> samples;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const Vector2d way = route[i] - route[i - 1];
    const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / kCell)));
    for (int k = i == 1 ? 0 : 1; k <= steps; ++k) samples.emplace_back(route[i - 1] + way * k / steps);
  }
  return samples;
}

/// The first sample from which on the route is free again, beyond what bars it first.
int rejoining(std::span<const Vector2d> samples, std::span<const float> clearance, double radius) {
  bool barred = false;
  int free = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Cell cell = cell_at(samples[i]);
    if (!cell.is_inside()) break;
    if (clearance[cell.index()] < radius) {
      barred = true;
      free = 0;
    } else if (barred && ++free * kCell >= 0.2) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

/// Cells left of the route cost more. Which side: by the direction of the route's chord.
double side_factor(const Vector2d& p, std::span<const Vector2d> samples, double to_the_left) {
  const Vector2d chord = samples.back() - samples.front();
  const Vector2d from = p - samples.front();
  return chord.x() * from.y() - chord.y() * from.x() > 0 ? 1 + to_the_left : 1;
}

/// What lies about the robot, and what a step to a cell costs.
struct Surroundings {
  std::vector<float> clearance;   ///< by cell
  std::vector<Vector2d> samples;  ///< of the route
  DetourOptions options;

  /// Infinite where there is no room. Who stands too near to something may leave it.
  [[nodiscard]] float step_cost(std::size_t from, const Cell& to, bool diagonal) const {
    const double room = static_cast<double>(clearance[to.index()]);
    if (room < options.radius && room <= static_cast<double>(clearance[from])) return kUnreachable;
    const double tight = std::clamp((options.comfortable - room) / (options.comfortable - options.radius), 0.0, 1.0);
    return static_cast<float>((diagonal ? std::numbers::sqrt2 : 1.0) * (1 + kTightness * tight) *
                              side_factor(to.centre(), samples, options.to_the_left));
  }
};

/// Cells from start to goal, both included; none if there is no way.
std::vector<std::size_t> cheapest_way(const Surroundings& around, std::size_t start, std::size_t goal) {
  std::vector<float> cost(around.clearance.size(), kUnreachable);
  std::vector<std::size_t> parent(cost.size(), start);
  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  cost[start] = 0;
  queue.push({0.F, start});
  while (!queue.empty() && queue.top().second != goal) {
    const auto [at_cost, at] = queue.top();
    queue.pop();
    if (at_cost > cost[at]) continue;
    const Cell cell = cell_of_index(at);
    for (int k = 0; k < 9; ++k) {
      const Cell next{cell.column + k % 3 - 1, cell.row + k / 3 - 1};
      if (k == 4 || !next.is_inside()) continue;
      const float reached = at_cost + around.step_cost(at, next, k % 2 == 0);
      if (reached >= cost[next.index()]) continue;
      cost[next.index()] = reached;
      parent[next.index()] = at;
      queue.push({reached, next.index()});
    }
  }
  std::vector<std::size_t> way;
  if (cost[goal] == kUnreachable) return way;
  for (std::size_t at = goal; at != start; at = parent[at]) way.push_back(at);
  way.push_back(start);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace

std::vector<Vector2d> find_detour(const LiveObstacles& obstacles, std::span<const Vector2d> route,
                                  const DetourOptions& options) {
  const Surroundings around{clearances(obstacles, options.comfortable + kCell), sampled(route), options};
  const int goal = rejoining(around.samples, around.clearance, options.radius + 0.02);
  if (goal < 0) return {};
  const auto rest = static_cast<std::size_t>(goal);
  const std::vector<std::size_t> cells =
      cheapest_way(around, cell_at({0, 0}).index(), cell_at(around.samples[rest]).index());
  std::vector<Vector2d> way;
  if (cells.empty()) return way;
  way.emplace_back(0, 0);
  for (std::size_t i = 1; i < cells.size(); ++i) way.push_back(cell_of_index(cells[i]).centre());
  way.insert(way.end(), around.samples.begin() + goal, around.samples.end());
  return way;
}

}  // namespace helicoid
