#include "helicoid/sensor/deskew.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

namespace {

/// A return as it is seen from the end of the sweep: its place among the beams, and its range.
struct MovedReturn {
  double beam = 0;
  double range = 0;
  bool valid = false;
};

std::vector<MovedReturn> move_returns(const Scan& scan, const LaserModel& laser, const Vector3d& twist) {
  std::vector<MovedReturn> moved(scan.ranges.size());
  const double last = std::max(1, laser.beams - 1);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!is_return(scan.ranges[i], laser)) continue;
    const auto beam = static_cast<double>(i);
    const double before_end = laser.scan_duration * (1 - beam / last);
    const Pose2 T_end_then = exponential(-before_end * twist);
    const Pose2 T_laser_then = scan.T_robot_laser.inverse() * T_end_then * scan.T_robot_laser;
    const double bearing = laser.first_bearing + beam * laser.bearing_step;
    const double range = scan.ranges[i];
    const Vector2d p = T_laser_then * Vector2d(range * std::cos(bearing), range * std::sin(bearing));
    // A beam turns by little: its bearing is looked for near where it was.
    const double turned = wrap_angle(std::atan2(p.y(), p.x()) - bearing);
    moved[i] = {beam + turned / laser.bearing_step, p.norm(), true};
  }
  return moved;
}

/// The range at which beam `at` meets the chord from a to b.
double chord_range(const MovedReturn& a, const MovedReturn& b, double at, double step) {
  const double to_a = (at - a.beam) * step;
  const double to_b = (b.beam - at) * step;
  return a.range * b.range * std::sin(to_a + to_b) / (a.range * std::sin(to_a) + b.range * std::sin(to_b));
}

}  // namespace

Scan deskew(const Scan& scan, const LaserModel& laser, const Vector3d& twist) {
  if (!(laser.scan_duration > 0) || twist == Vector3d::Zero()) return scan;
  const std::vector<MovedReturn> moved = move_returns(scan, laser, twist);
  Scan corrected = scan;
  const auto count = static_cast<double>(moved.size());
  // Beams that no surface falls on any more keep no range that could be wrong.
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (moved[i].valid) corrected.ranges[i] = std::numeric_limits<float>::quiet_NaN();
  }
  for (std::size_t i = 0; i + 1 < moved.size(); ++i) {
    const MovedReturn& a = moved[i];
    const MovedReturn& b = moved[i + 1];
    // Surfaces that have turned behind one another are left to the beams beside them.
    if (!a.valid || !b.valid || !(a.beam < b.beam) || b.beam - a.beam > 3) continue;
    const bool one_surface = std::abs(b.range - a.range) <= laser.largest_gap;
    for (double at = std::max(0.0, std::ceil(a.beam)); at <= b.beam && at < count; ++at) {
      const MovedReturn& nearer = at - a.beam < b.beam - at ? a : b;
      const double range = one_surface ? chord_range(a, b, at, laser.bearing_step) : nearer.range;
      corrected.ranges[static_cast<std::size_t>(at)] = static_cast<float>(range);
    }
  }
  return corrected;
}

}  // namespace helicoid
