#include "apps/chauffeur.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kReached = 0.08;   // metres
constexpr double kAlong = 0.06;     // farther to the side than this the robot turns on the spot, radians
constexpr double kLookAhead = 0.5;  // along the line to the next point, metres
constexpr double kBraking = 0.6;    // metres a second squared

}  // namespace

Chauffeur::Chauffeur(const Route& route, double top_speed, double top_turn_rate)
    : points_(route.points), top_speed_(top_speed), top_turn_rate_(top_turn_rate) {
  if (route.closed) return;
  for (std::size_t i = points_.size() - 1; i-- > 1;) points_.push_back(points_[i]);
}

Pose2 Chauffeur::T_world_start() const {
  const Vector2d along = points_[1 % points_.size()] - points_[0];
  return {points_[0].x(), points_[0].y(), std::atan2(along.y(), along.x())};
}

DriveCommand Chauffeur::command(const Pose2& T_world_robot) {
  const Vector2d here = T_world_robot.translation();
  if ((points_[next_] - here).norm() < kReached) next_ = (next_ + 1) % points_.size();
  const Vector2d& to = points_[next_];
  const Vector2d& from = points_[(next_ + points_.size() - 1) % points_.size()];
  // Back onto the line between the two points, and along it.
  const Vector2d along = (to - from).normalized();
  const double left = (to - here).dot(along);
  const Vector2d target = left > kLookAhead ? to - (left - kLookAhead) * along : to;
  const Vector2d p_robot = T_world_robot.inverse() * target;
  const double bearing = std::atan2(p_robot.y(), p_robot.x());
  const double turn = std::clamp(2.5 * bearing, -top_turn_rate_, top_turn_rate_);
  if (std::abs(bearing) > 4 * kAlong) return {0, turn};
  const double speed = std::min(top_speed_, 0.05 + std::sqrt(kBraking * std::max(0.0, (to - here).norm() - kReached)));
  return {std::abs(bearing) > kAlong ? 0.5 * speed : speed, turn};
}

}  // namespace helicoid
