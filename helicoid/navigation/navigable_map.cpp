#include "helicoid/navigation/navigable_map.hpp"

namespace helicoid {

NavigableMap::NavigableMap(const Map& map, const Neighbours& neighbours, const NavigationOptions& options,
                           const NavigableMap* before)
    : plan_(std::make_shared<const FloorPlan>(
          make_floor_plan(map, neighbours, options, before != nullptr ? before->plan_.get() : nullptr))) {}

double NavigableMap::clearance(const ManifoldPoint& point) const {
  const std::optional<FloorPlace> place = plan_->locate(point);
  if (!place) return 0;
  const FloorTile& tile = *plan_->tiles[place->tile];
  return tile.clearance_between(project(point) - tile.block.halo_corner());
}

bool NavigableMap::is_passable(const ManifoldPoint& point) const {
  const std::optional<FloorPlace> place = plan_->locate(point);
  return place && plan_->clearance_cm(*place) >= least_clearance_cm(plan_->options);
}

}  // namespace helicoid
