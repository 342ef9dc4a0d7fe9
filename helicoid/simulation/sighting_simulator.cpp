#include "helicoid/simulation/sighting_simulator.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kNearest = 0.3;  // nearer, the fiducial does not fit into the picture; metres

}  // namespace

bool is_hidden(const RayCaster& walls, std::span<const Disc> discs, const Vector2d& from, const Vector2d& to) {
  const double range = (to - from).norm();
  const Vector2d direction = (to - from) / range;
  if (walls.cast(from, direction, range).segment >= 0) return true;
  return std::any_of(discs.begin(), discs.end(), [&](const Disc& d) {
    const double along = (d.centre - from).dot(direction);
    const bool is_target = (d.centre - to).norm() < 1e-9;
    return !is_target && along > 0 && along < range && (d.centre - from - along * direction).norm() < d.radius;
  });
}

std::optional<Sighting> simulate_sighting(const RayCaster& walls, std::span<const Disc> discs,
                                          const Pose2& T_world_observer, const Pose2& T_world_observed,
                                          const std::string& observed, const SightingLimits& limits,
                                          const SightingNoise& noise, Random& random) {
  const Pose2 T_observer_observed = T_world_observer.inverse() * T_world_observed;
  const double range = T_observer_observed.distance();
  const double bearing = std::atan2(T_observer_observed.y, T_observer_observed.x);
  if (range > limits.range || range < kNearest) return std::nullopt;
  if (std::abs(bearing) > 0.5 * limits.view) return std::nullopt;
  if (is_hidden(walls, discs, T_world_observer.translation(), T_world_observed.translation())) return std::nullopt;
  return Sighting{observed,
                  range + noise.range_sigma * random.normal(),
                  wrap_angle(bearing + noise.bearing_sigma * random.normal()),
                  wrap_angle(T_observer_observed.yaw + noise.orientation_sigma * random.normal()),
                  noise.range_sigma,
                  noise.bearing_sigma,
                  noise.orientation_sigma};
}

}  // namespace helicoid
