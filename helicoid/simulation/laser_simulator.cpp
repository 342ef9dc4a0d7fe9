#include "helicoid/simulation/laser_simulator.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace helicoid {

namespace {

constexpr double kNoReturn = 81.83;
constexpr double kReach = 80;

double meet_disc(const Vector2d& origin, const Vector2d& direction, const Disc& disc) {
  const Vector2d offset = disc.centre - origin;
  const double along = offset.dot(direction);
  const double square = disc.radius * disc.radius - (offset.squaredNorm() - along * along);
  if (square < 0 || along - std::sqrt(square) < 0) return std::numeric_limits<double>::infinity();
  return along - std::sqrt(square);
}

/// The surface that a thin ray meets: how far, and how flat it is seen (sine of the grazing angle).
struct Surface {
  double distance = 0;
  double sine = 1;
  int segment = -1;  ///< of the walls; -1: a disc, or nothing
};

Surface look(const RayCaster& walls, std::span<const Disc> discs, const Vector2d& origin, double bearing) {
  const Vector2d direction(std::cos(bearing), std::sin(bearing));
  const RayCaster::Hit hit = walls.cast(origin, direction, kReach);
  Surface surface{hit.distance, 1, hit.segment};
  if (hit.segment >= 0) {
    const Segment& s = walls.segments()[static_cast<std::size_t>(hit.segment)];
    const Vector2d along = (s.to - s.from).normalized();
    surface.sine = std::abs(direction.x() * along.y() - direction.y() * along.x());
  }
  for (const Disc& disc : discs) {
    const double distance = meet_disc(origin, direction, disc);
    if (distance < surface.distance) surface = {distance, 1, -1};
  }
  return surface;
}

}  // namespace

LaserModel simulated_lms200() {
  LaserModel laser;
  laser.name = "SICK LMS200";
  laser.beams = 180;
  laser.first_bearing = -0.5 * std::numbers::pi;
  laser.bearing_step = std::numbers::pi / 180;
  laser.max_range = 0.999 * kNoReturn;
  return laser;
}

std::vector<double> draw_materials(std::size_t segments, const LaserNoise& noise, Random random) {
  std::vector<double> materials(segments);
  for (double& bias : materials) bias = noise.material_sigma * random.normal();
  return materials;
}

LaserBias draw_laser_bias(const LaserNoise& noise, std::vector<double> materials, Random& random) {
  return {noise.range_bias_sigma * random.normal(), noise.bearing_scale_sigma * random.normal(), std::move(materials)};
}

std::vector<float> simulate_ranges(const RayCaster& walls, std::span<const Disc> discs, const LaserModel& laser,
                                   const Pose2& T_world_named, const Vector3d& twist, const LaserNoise& noise,
                                   const LaserBias& bias, Random& random) {
  Pose2 T_world_laser = T_world_named;
  if (noise.timing_sigma > 0) {
    T_world_laser = T_world_laser * exponential(noise.timing_sigma * random.normal() * twist);
  }
  std::vector<float> ranges;
  ranges.reserve(static_cast<std::size_t>(laser.beams));
  double previous = 0;
  for (int beam = 0; beam < laser.beams; ++beam) {
    const double when = noise.sweep * (static_cast<double>(beam) / laser.beams - 0.5);
    const Pose2 T_world_now = when != 0 ? T_world_laser * exponential(when * twist) : T_world_laser;
    const Vector2d origin = T_world_now.translation();
    const double bearing = T_world_now.yaw + (1 + bias.bearing_scale) * laser.bearing(beam);
    const Surface surface = look(walls, discs, origin, bearing);
    double range = surface.distance;
    // A beam has a width: where the surface jumps, its two edges may see different things and the range is a mixture.
    if (noise.mixed > 0 && std::abs(range - previous) > 0.1) {
      const double left = look(walls, discs, origin, bearing + 0.5 * noise.beam_divergence).distance;
      const double right = look(walls, discs, origin, bearing - 0.5 * noise.beam_divergence).distance;
      if (std::abs(left - right) > 0.1 && left < kReach && right < kReach && random.chance(noise.mixed)) {
        range = left + random.uniform() * (right - left);
      }
    }
    previous = surface.distance;
    const bool swallowed = (noise.missing > 0 && random.chance(noise.missing)) ||
                           (surface.sine < std::sin(noise.grazing_angle) && random.chance(0.5));
    if (!(range < kReach) || swallowed) {
      ranges.push_back(static_cast<float>(kNoReturn));
      continue;
    }
    range += bias.range;
    if (surface.segment >= 0 && !bias.by_surface.empty()) {
      range += bias.by_surface[static_cast<std::size_t>(surface.segment)];
    }
    if (noise.range_sigma > 0) range += noise.range_sigma * random.normal();
    if (noise.quantum > 0) range = noise.quantum * std::round(range / noise.quantum);
    ranges.push_back(static_cast<float>(std::max(range, 0.01)));
  }
  return ranges;
}

}  // namespace helicoid
