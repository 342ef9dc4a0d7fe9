// What a robot's wheels report of how it moves.
#pragma once

#include "helicoid/base/random.hpp"
#include "helicoid/geometry/pose2.hpp"
#include "helicoid/simulation/noise.hpp"

namespace helicoid {

/// Counts what the wheels do; its scales stay with the robot for as long as it lives.
class Odometer {
 public:
  /// Draws what is wrong with this one.
  Odometer(const OdometryNoise& noise, Random& random);

  /// The wheels carry the robot, as far as they can tell, through `T_before_after`.
  void count(const Pose2& T_before_after, Random& random);
  [[nodiscard]] const Pose2& T_odom_robot() const { return T_odom_robot_; }

 private:
  OdometryNoise noise_;
  double distance_scale_ = 1, turn_scale_ = 1, drift_ = 0;
  Pose2 T_odom_robot_;
};

}  // namespace helicoid
