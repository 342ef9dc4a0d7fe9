#include "helicoid/navigation/navigable_map.hpp"

namespace helicoid {

NavigableMap::NavigableMap(const Map& map, const Neighbours& neighbours, const NavigationOptions& options,
                           const NavigableMap* before)
    : plan_(std::make_shared<const FloorPlan>(
          make_floor_plan(map, neighbours, options, before != nullptr ? before->plan_.get() : nullptr))) {}

bool lies_in(std::span<const Vector2d> ring, const Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d& a = ring[i];
    const Vector2d& b = ring[(i + 1) % ring.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

void NavigableMap::forbid(std::span<const ForbiddenFloor> regions) {
  forbidden_.assign(regions.empty() ? 0 : plan_->place_count(), false);
  for (const ForbiddenFloor& region : regions) {
    const Pose2 T_frame_plane = plan_->T_plane_patch[region.frame.index()].inverse();
    const IslandId island = plan_->island_of[region.frame.index()];
    for (std::uint32_t place = 0; place < forbidden_.size(); ++place) {
      const FloorPlace at = place_of(place);
      if (plan_->island_of[plan_->tiles[at.tile]->patches.front().index()] != island) continue;
      if (lies_in(region.ring_patch, T_frame_plane * plan_->centre(at))) forbidden_[place] = true;
    }
  }
}

std::vector<bool> NavigableMap::forbidden_from(const FloorPlace& start) const {
  const bool starts_there = !forbidden_.empty() && forbidden_[number_of(start)];
  return starts_there ? std::vector<bool>() : forbidden_;
}

bool NavigableMap::is_forbidden(const ManifoldPoint& point) const {
  if (forbidden_.empty()) return false;
  const std::optional<FloorPlace> place = plan_->locate(point);
  return place && forbidden_[number_of(*place)];
}

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
