// What a perfect laser sees of straight walls: for tests of what is made of scans.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "helicoid/base/random.hpp"
#include "helicoid/geometry/ray_casting.hpp"
#include "helicoid/sensor/event.hpp"
#include "helicoid/sensor/laser_model.hpp"

namespace helicoid::synthetic {

inline LaserModel lms200() {
  LaserModel laser;
  laser.name = "SICK LMS200";
  laser.beams = 181;
  laser.first_bearing = -0.5 * std::numbers::pi;
  laser.bearing_step = std::numbers::pi / 180;
  laser.max_range = 81;
  return laser;
}

/// A laser that sees all round.
inline LaserModel all_round() {
  LaserModel laser = lms200();
  laser.beams = 360;
  laser.first_bearing = -std::numbers::pi;
  return laser;
}

/// How far it is to the first wall; 100 m if there is none.
inline double visible(const RayCaster& walls, const Pose2& T_world_laser, double bearing) {
  const double angle = T_world_laser.yaw + bearing;
  const RayCaster::Hit hit = walls.cast(T_world_laser.translation(), {std::cos(angle), std::sin(angle)}, 100);
  return hit.segment >= 0 ? hit.distance : 100;
}

inline Scan look(const RayCaster& walls, const LaserModel& laser, const Pose2& T_world_robot,
                 const Pose2& T_robot_laser = {}) {
  Scan scan;
  scan.T_odom_robot = T_world_robot;
  scan.T_robot_laser = T_robot_laser;
  for (int beam = 0; beam < laser.beams; ++beam) {
    scan.ranges.push_back(static_cast<float>(visible(walls, T_world_robot * T_robot_laser, laser.bearing(beam))));
  }
  return scan;
}

/// Walls of a building of about 20 m by 12 m: an outer wall with an opening, inner walls with doors, boxes and poles.
inline std::vector<Segment> cluttered_building(Random& random) {
  std::vector<Segment> walls{
      {{0, 0}, {20, 0}}, {{20, 0}, {20, 12}}, {{0, 12}, {0, 0}}, {{0, 12}, {14, 12}}, {{16, 12}, {20, 12}}};
  for (int i = 0; i < 6; ++i) {
    const Vector2d from(random.uniform(1, 19), random.uniform(1, 11));
    const double angle =
        random.chance(0.7) ? 0.5 * std::numbers::pi * static_cast<double>(random.below(4)) : random.uniform(-3, 3);
    walls.push_back({from, from + random.uniform(0.5, 5) * Vector2d(std::cos(angle), std::sin(angle))});
  }
  for (int i = 0; i < 8; ++i) {
    const Vector2d low(random.uniform(1, 19), random.uniform(1, 11));
    const Vector2d high = low + Vector2d::Constant(random.uniform(0.05, 0.8));
    walls.push_back({low, {high.x(), low.y()}});
    walls.push_back({{high.x(), low.y()}, high});
    walls.push_back({high, {low.x(), high.y()}});
    walls.push_back({{low.x(), high.y()}, low});
  }
  return walls;
}

}  // namespace helicoid::synthetic
