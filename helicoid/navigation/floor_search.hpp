// Cheapest ways over the floor from one place (Dijkstra 1959, over the cells of all sheets).
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "helicoid/navigation/floor_plan.hpp"

namespace helicoid {

/// The nearest place that may be driven through, found without coming nearer to any obstacle on the way: never through
/// a wall. The place itself if it will do; none within `reach` metres.
[[nodiscard]] std::optional<FloorPlace> standing_near(const FloorPlan& plan, const FloorPlace& place, double reach);

struct FloorSearch {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> cost;    ///< by place; kNone: not reached
  std::vector<std::uint32_t> parent;  ///< by place; the start's is itself
  std::vector<float> length;          ///< metres along the cheapest way, by place

  /// From the start to the place, both included; empty if it was not reached.
  [[nodiscard]] std::vector<FloorPlace> way_to(const FloorPlace& place) const;
};

/// Up to the goal, or everywhere without one. Places for which `closed` (by number; may be empty) is true are left out.
[[nodiscard]] FloorSearch search_floor(const FloorPlan& plan, const FloorPlace& start,
                                       const std::optional<FloorPlace>& goal = std::nullopt,
                                       const std::vector<bool>& closed = {});

}  // namespace helicoid
