#include "helicoid/manifold/patch.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/sensor/free_space.hpp"

namespace helicoid {

Patch make_patch(PatchId id, RobotId robot, std::size_t scan_index, double stamp, Scan scan, const LaserModel& laser) {
  ScanPointExtractor extractor(laser);
  return make_patch(id, robot, scan_index, stamp, std::move(scan), extractor);
}

Patch make_patch(PatchId id, RobotId robot, std::size_t scan_index, double stamp, Scan scan,
                 ScanPointExtractor& extractor) {
  Patch patch{id, robot, scan_index, stamp, std::move(scan), extractor.laser(), {}, {}, {}, 0, 0};
  patch.free_space = free_space_polygon(patch.scan, patch.laser, extractor.beams());
  patch.free_ranges = free_ranges(patch.scan, patch.laser);
  patch.points = extractor.extract(patch.scan);
  for (const auto& vertex : patch.free_space)
    patch.free_reach = std::max(patch.free_reach, static_cast<double>(vertex.norm()));
  patch.reach = patch.free_reach;
  for (std::size_t i = 0; i < patch.points.size(); ++i) {
    patch.reach = std::max(patch.reach, static_cast<double>(std::hypot(patch.points.x[i], patch.points.y[i])));
  }
  return patch;
}

bool contains(const Patch& patch, const Vector2d& p_patch) {
  const Vector2d p_laser = patch.scan.T_robot_laser.inverse() * p_patch;
  const double range = p_laser.norm();
  if (range == 0) return !patch.free_space.empty();
  const LaserModel& laser = patch.laser;
  const double offset =
      wrap_angle(std::atan2(p_laser.y(), p_laser.x()) - laser.first_bearing - 0.5 * laser.field_of_view()) +
      0.5 * laser.field_of_view();
  const double at = offset / laser.bearing_step;
  const double below = std::floor(at);
  if (below < 0 || below + 1 > laser.beams - 1) return at == laser.beams - 1 && range <= patch.free_ranges.back();
  const auto i = static_cast<std::size_t>(below);
  const double r0 = patch.free_ranges[i];
  const double r1 = patch.free_ranges[i + 1];
  if (r0 <= 0 || r1 <= 0) return false;
  // Inside the triangle of the laser and the two beams' ends: below the chord in polar form.
  const double a = (at - below) * laser.bearing_step;
  const double b = laser.bearing_step - a;
  return range * (r0 * std::sin(a) + r1 * std::sin(b)) <= r0 * r1 * std::sin(laser.bearing_step);
}

bool is_ground(const Patch& patch, const Vector2d& p_patch) {
  constexpr double kBody = 0.25;  // metres about the robot's origin
  return p_patch.squaredNorm() <= kBody * kBody || contains(patch, p_patch);
}

}  // namespace helicoid
