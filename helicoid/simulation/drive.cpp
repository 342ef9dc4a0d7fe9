#include "helicoid/simulation/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace helicoid {

namespace {

constexpr double kSharp = 0.5;     // a bend that the robot drives to before it turns, radians
constexpr double kReached = 0.05;  // metres
constexpr double kStep = 0.02;     // by which the target is pushed, metres

}  // namespace

RouteDriver::RouteDriver(Route route, double share, bool backward, const DriveLimits& limits) : limits_(limits) {
  points_ = std::move(route.points);
  if (route.closed) {
    if (backward) std::reverse(points_.begin(), points_.end());
    points_.push_back(points_.front());
  } else {
    for (std::size_t i = points_.size() - 1; i-- > 0;) points_.push_back(points_[i]);
  }
  along_.push_back(0);
  for (std::size_t i = 1; i < points_.size(); ++i)
    along_.push_back(along_.back() + (points_[i] - points_[i - 1]).norm());
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Vector2d before = points_[i] - points_[i - 1];
    const Vector2d after = points_[i + 1 < points_.size() ? i + 1 : 1] - points_[i];
    const double bend = std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
    if (std::abs(bend) > kSharp) corners_.push_back(along_[i]);
  }
  at_ = start_ = share * along_.back();
  corner_ = next_corner(at_);
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

/// The first sharp bend beyond `along`, which may lie in a later lap; infinity if there is none.
double RouteDriver::next_corner(double along) const {
  if (corners_.empty()) return std::numeric_limits<double>::infinity();
  const double length = along_.back();
  const double lap = std::floor(along / length);
  const auto next = std::upper_bound(corners_.begin(), corners_.end(), along - lap * length + kStep / 2);
  return next != corners_.end() ? lap * length + *next : (lap + 1) * length + corners_.front();
}

/// Pushes the target along the route until it is out of reach again; at sharp bends it waits for the robot.
void RouteDriver::push_target(double aside) {
  const auto distance = [&] { return (target(aside) - T_world_robot_.translation()).norm(); };
  while (distance() < limits_.look_ahead) {
    if (at_ + kStep >= corner_) {
      at_ = corner_;
      if (distance() > kReached) return;
      corner_ = next_corner(at_);
    }
    at_ += kStep;
  }
}

Vector2d RouteDriver::target(double aside) const {
  Vector2d p = point_at(at_);
  if (aside == 0) return p;
  const Vector2d along = (p - point_at(at_ - kStep)).normalized();
  return p + aside * Vector2d(along.y(), -along.x());
}

void RouteDriver::step(double dt, double aside) {
  push_target(aside);
  laps_ = static_cast<int>(std::floor((at_ - start_) / along_.back()));
  const Vector2d p_robot_target = T_world_robot_.inverse() * target(aside);
  const double side = std::atan2(p_robot_target.y(), p_robot_target.x());
  const double turn = std::clamp(2 * side / dt, -limits_.turn_rate, limits_.turn_rate);
  const double omega = std::abs(side) < limits_.turn_rate * dt ? side / dt : turn;
  const double speed =
      std::abs(side) > limits_.turn_in_place ? 0 : limits_.speed * (1 - std::abs(side) / limits_.turn_in_place);
  T_world_robot_ =
      T_world_robot_ * exponential(Vector3d(std::min(speed, p_robot_target.norm() / dt) * dt, 0, omega * dt));
}

}  // namespace helicoid
