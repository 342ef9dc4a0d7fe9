// How far it is from a robot to everywhere that it can reach.
#pragma once

#include <limits>

#include "helicoid/navigation/floor_search.hpp"
#include "helicoid/navigation/navigable_map.hpp"

namespace helicoid {

/// Keeps the snapshot that it was asked of.
class DistanceField {
 public:
  DistanceField(std::shared_ptr<const FloorPlan> plan, FloorSearch search)
      : plan_(std::move(plan)), search_(std::move(search)) {}

  /// Metres along the cheapest way over the floor, a few per cent more than the taut route has; infinity if the point
  /// cannot be reached, or does not lie within NavigationOptions::reach of floor that can.
  [[nodiscard]] double metres_to(const ManifoldPoint& point) const;
  /// True if the field holds any distance: the robot stands on ground that may be driven.
  [[nodiscard]] bool is_on_ground() const { return !search_.cost.empty(); }

 private:
  std::shared_ptr<const FloorPlan> plan_;
  FloorSearch search_;
};

/// All infinite if the robot does not stand on ground.
[[nodiscard]] DistanceField distances_from(const NavigableMap& map, const ManifoldPose& robot);
[[nodiscard]] DistanceField distances_from(const NavigableMap& map, const ManifoldPoint& point);

}  // namespace helicoid
