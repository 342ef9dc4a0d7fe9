#include "helicoid/simulation/drive.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

RouteDriver::RouteDriver(Route route, double share, bool backward, const DriveLimits& limits) : limits_(limits) {
  points_ = std::move(route.points);
  if (route.closed) {
    if (backward) std::reverse(points_.begin(), points_.end());
    points_.push_back(points_.front());
  } else {
    for (std::size_t i = points_.size() - 1; i-- > 0;) points_.push_back(points_[i]);
  }
  along_.push_back(0);
  for (std::size_t i = 1; i < points_.size(); ++i) along_.push_back(along_.back() + (points_[i] - points_[i - 1]).norm());
  at_ = start_ = share * along_.back();
  const Vector2d here = point_at(at_);
  const Vector2d ahead = point_at(at_ + 0.3) - here;
  T_world_robot_ = {here.x(), here.y(), std::atan2(ahead.y(), ahead.x())};
}

Vector2d RouteDriver::point_at(double along) const {
  const double length = along_.back();
  along -= length * std::floor(along / length);
  const auto next = std::upper_bound(along_.begin(), along_.end(), along);
  const auto i = std::clamp<std::ptrdiff_t>(next - along_.begin(), 1, std::ssize(along_) - 1);
  const double span = along_[i] - along_[i - 1];
  const double share = span > 0 ? (along - along_[i - 1]) / span : 0;
  return points_[i - 1] + share * (points_[i] - points_[i - 1]);
}

void RouteDriver::step(double dt) {
  // The target is pushed along the route until it is out of reach again; at sharp corners it waits for the robot.
  while ((point_at(at_) - T_world_robot_.translation()).norm() < limits_.look_ahead) {
    const Vector2d before = point_at(at_) - point_at(at_ - 0.02);
    const Vector2d after = point_at(at_ + 0.02) - point_at(at_);
    const double bend = std::abs(std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after)));
    if (bend > 0.5 && (point_at(at_) - T_world_robot_.translation()).norm() > 0.05) break;
    at_ += 0.02;
  }
  laps_ = static_cast<int>(std::floor((at_ - start_) / along_.back()));
  const Vector2d target = T_world_robot_.inverse() * point_at(at_);
  const double side = std::atan2(target.y(), target.x());
  const double turn = std::clamp(2 * side / dt, -limits_.turn_rate, limits_.turn_rate);
  const double omega = std::abs(side) < limits_.turn_rate * dt ? side / dt : turn;
  const double speed = std::abs(side) > limits_.turn_in_place ? 0 : limits_.speed * (1 - std::abs(side) / limits_.turn_in_place);
  T_world_robot_ = T_world_robot_ * exponential(Vector3d(std::min(speed, target.norm() / dt) * dt, 0, omega * dt));
}

}  // namespace helicoid
