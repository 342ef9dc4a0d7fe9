#include "helicoid/mapping/seen_robots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace helicoid {

void SeenRobots::see(const Pose2& T_odom_robot, double stamp, const Sighting& sighting) {
  if (!sighting.range || !sighting.bearing) return;
  const Vector2d p_robot = *sighting.range * Vector2d(std::cos(*sighting.bearing), std::sin(*sighting.bearing));
  Seen now{sighting.observed, stamp, T_odom_robot * p_robot, Vector2d::Zero()};
  const auto before = std::find_if(seen_.begin(), seen_.end(), [&](const Seen& s) { return s.name == now.name; });
  if (before == seen_.end()) {
    seen_.push_back(std::move(now));
    return;
  }
  // One that was not identified may be another each time.
  const double since = stamp - before->stamp;
  if (now.name != "?" && since > 0 && since < 2 * options_.memory) {
    const Vector2d velocity = (now.p_odom - before->p_odom) / since;
    if (velocity.norm() < options_.fastest) now.velocity = velocity;
  }
  *before = std::move(now);
}

std::optional<ClearedScan> SeenRobots::clear(const Scan& scan, double stamp, const LaserModel& laser) const {
  if (!scan.has_odometry) return std::nullopt;
  const Pose2 T_laser_odom = (scan.T_odom_robot * scan.T_robot_laser).inverse();
  std::optional<ClearedScan> cleared;
  for (const Seen& seen : seen_) {
    const double since = stamp - seen.stamp;
    if (since < 0 || since > options_.memory) continue;
    const Vector2d p_laser = T_laser_odom * Vector2d(seen.p_odom + since * seen.velocity);
    const double radius = options_.body + options_.uncertainty * since;
    for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
      const double bearing = laser.bearing(static_cast<int>(i));
      const Vector2d p = scan.ranges[i] * Vector2d(std::cos(bearing), std::sin(bearing));
      if (!((p - p_laser).norm() < radius)) continue;
      if (!cleared) cleared = ClearedScan{scan, 0};
      cleared->scan.ranges[i] = std::numeric_limits<float>::quiet_NaN();
      ++cleared->removed;
    }
  }
  return cleared;
}

}  // namespace helicoid
