// Where a robot stands to look over an edge: places on known floor that it can go to.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "helicoid/exploration/frontiers.hpp"

namespace helicoid {

/// True if some robot has a way there.
[[nodiscard]] bool is_reachable(const ManifoldPoint& point, std::span<const Travel> travel);

/// The nearest place to the edge, by the way over known floor, that a robot can stand on and go to.
class GoalSearch {
 public:
  /// Whether a place that can be reached will do.
  using Suits = std::function<bool(const ManifoldPoint&)>;

  GoalSearch(const Map& map, const GroundWindow& window, std::span<const PatchId> patches,
             const FrontierOptions& options)
      : map_(map), window_(window), patches_(patches), options_(options), way_(window.cells(), -1) {}

  std::optional<ManifoldPoint> find(std::span<const GroundCell> edge, std::span<const Travel> travel,
                                    const Suits& suits);

 private:
  void push(const GroundCell& cell, int way, bool is_edge);
  [[nodiscard]] bool is_new_try(const GroundCell& cell) const;

  const Map& map_;
  const GroundWindow& window_;
  std::span<const PatchId> patches_;
  const FrontierOptions& options_;
  std::vector<int> way_;
  std::deque<GroundCell> open_;
  std::vector<GroundCell> tried_;
};

/// The nearest place to a point (plane), as the crow flies, that a robot can stand on and go to.
[[nodiscard]] std::optional<ManifoldPoint> nearest_stand(const Map& map, const GroundWindow& window,
                                                         std::span<const PatchId> patches, const Vector2d& p_plane,
                                                         std::span<const Travel> travel,
                                                         const FrontierOptions& options);

}  // namespace helicoid
