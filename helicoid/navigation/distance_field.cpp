#include "helicoid/navigation/distance_field.hpp"

namespace helicoid {

double DistanceField::metres_to(const ManifoldPoint& point) const {
  constexpr double kUnreachable = std::numeric_limits<double>::infinity();
  if (!is_on_ground()) return kUnreachable;
  const std::optional<FloorPlace> place = plan_->locate(point);
  if (!place) return kUnreachable;
  const std::optional<FloorPlace> standing = standing_near(*plan_, *place, plan_->options.reach);
  if (!standing) return kUnreachable;
  return static_cast<double>(search_.length[number_of(*standing)]) +
         (plan_->centre(*standing) - plan_->centre(*place)).norm();
}

DistanceField distances_from(const NavigableMap& map, const ManifoldPoint& point) {
  const std::shared_ptr<const FloorPlan>& plan = map.plan();
  const std::optional<FloorPlace> place = plan->locate(point);
  const std::optional<FloorPlace> start = place ? standing_near(*plan, *place, plan->options.reach) : std::nullopt;
  if (!start) return {plan, {}};
  return {plan, search_floor(*plan, *start, std::nullopt, map.forbidden_from(*start))};
}

DistanceField distances_from(const NavigableMap& map, const ManifoldPose& robot) {
  return distances_from(map, point_of(robot));
}

}  // namespace helicoid
