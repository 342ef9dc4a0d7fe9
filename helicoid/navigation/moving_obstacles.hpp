// What moves by itself, people and other robots: it stands now where a moment ago the laser saw through.
#pragma once

#include <deque>
#include <span>
#include <vector>

#include "helicoid/sensor/event.hpp"
#include "helicoid/sensor/laser_model.hpp"

namespace helicoid {

struct MovingObstacle {
  Vector2d p_robot;    ///< the nearest point of what has come into free space, metres, frame of the latest scan
  Vector2d direction;  ///< in which it moves, unit vector, the same frame; zero if that is not known
};

/// Needs odometry: without it nothing is seen to move.
class MovingObstacles {
 public:
  /// `dt` seconds after the scan before.
  void see(const Scan& scan, const LaserModel& laser, double dt);
  [[nodiscard]] std::span<const MovingObstacle> all() const { return all_; }

 private:
  struct View {
    Pose2 T_odom_laser;
    std::vector<float> ranges;
    double age = 0;  ///< seconds

    [[nodiscard]] bool sees_through(const Vector2d& p_odom, const LaserModel& laser) const;
    [[nodiscard]] bool sees_gone(const Vector2d& p_odom, const LaserModel& laser) const;
  };
  std::deque<View> views_;  ///< the latest last
  std::vector<MovingObstacle> all_;
};

}  // namespace helicoid
