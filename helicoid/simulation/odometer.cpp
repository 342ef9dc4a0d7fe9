#include "helicoid/simulation/odometer.hpp"

#include <cmath>

namespace helicoid {

Odometer::Odometer(const OdometryNoise& noise, Random& random) : noise_(noise) {
  distance_scale_ = 1 + noise.distance_scale_sigma * random.normal();
  turn_scale_ = 1 + noise.turn_scale_sigma * random.normal();
  drift_ = noise.drift_bias_sigma * random.normal();
}

void Odometer::count(const Pose2& T_before_after, Random& random) {
  const double distance = T_before_after.distance();
  const double turn = std::abs(T_before_after.yaw);
  Pose2 measured;
  measured.x = distance_scale_ * T_before_after.x + noise_.distance_sigma * std::sqrt(distance) * random.normal();
  measured.y = T_before_after.y;
  measured.yaw = turn_scale_ * T_before_after.yaw + drift_ * distance +
                 noise_.turn_sigma * std::sqrt(turn) * random.normal() +
                 noise_.drift_sigma * std::sqrt(distance) * random.normal();
  if (noise_.slip_per_metre > 0 && random.chance(noise_.slip_per_metre * distance)) {
    measured.yaw += noise_.slip_turn * random.normal();
  }
  if (distance == 0 && turn == 0) return;
  T_odom_robot_ = T_odom_robot_ * measured;
}

}  // namespace helicoid
