#include "helicoid/navigation/live_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

namespace {

constexpr double kReach = 4.0;       // beyond this nothing is looked at, metres
constexpr double kRemembered = 1.2;  // what is farther off is not remembered, metres
constexpr double kLongest = 4.0;     // seconds
constexpr double kStep = 0.03;       // along a way, metres

/// What bars the way of a disc: what it would touch, and it comes nearer to that than it is now.
bool bars(const Vector2d& obstacle, const Vector2d& p, double radius) {
  const double squared = (obstacle - p).squaredNorm();
  return squared < radius * radius && squared < obstacle.squaredNorm() - 1e-9;
}

bool is_free(std::span<const Vector2d> obstacles, const Vector2d& p, double radius) {
  return std::none_of(obstacles.begin(), obstacles.end(), [&](const Vector2d& o) { return bars(o, p, radius); });
}

}  // namespace

std::vector<Vector2d> surfaces_within(double reach, std::span<const float> ranges, const LaserModel& laser,
                                      const Pose2& T_frame_laser) {
  std::vector<Vector2d> points;
  const std::size_t beams = std::min(ranges.size(), static_cast<std::size_t>(laser.beams));
  for (std::size_t i = 0; i < beams; ++i) {
    const auto range = static_cast<double>(ranges[i]);
    if (!is_return(ranges[i], laser) || range > reach) continue;
    const double bearing = laser.bearing(static_cast<int>(i));
    points.push_back(T_frame_laser * Vector2d(range * std::cos(bearing), range * std::sin(bearing)));
  }
  return points;
}

void LiveObstacles::see(const Scan& scan, const LaserModel& laser, double dt) {
  points_ = surfaces_within(kReach, scan.ranges, laser, scan.T_robot_laser);
  if (scan.has_odometry) remember(scan, laser, dt);
}

void LiveObstacles::remember(const Scan& scan, const LaserModel& laser, double dt) {
  const std::size_t seen = points_.size();
  const Pose2 T_robot_odom = scan.T_odom_robot.inverse();
  const Pose2 T_laser_odom = scan.T_robot_laser.inverse() * T_robot_odom;
  const double middle = laser.first_bearing + 0.5 * laser.field_of_view();
  const auto is_in_view = [&](const Vector2d& p_odom) {
    const Vector2d p = T_laser_odom * p_odom;
    return std::abs(wrap_angle(std::atan2(p.y(), p.x()) - middle)) <= 0.5 * laser.field_of_view();
  };
  for (const Vector2d& p : in_view_) remembered_.push_back({p, 0});
  std::erase_if(remembered_, [&](Remembered& point) {
    point.age += dt;
    return point.age > kLongest || (T_robot_odom * point.p_odom).norm() > kRemembered || is_in_view(point.p_odom);
  });
  for (const Remembered& point : remembered_) points_.push_back(T_robot_odom * point.p_odom);
  in_view_.clear();
  for (std::size_t i = 0; i < seen; ++i) {
    if (points_[i].norm() < kRemembered) in_view_.push_back(scan.T_odom_robot * points_[i]);
  }
}

double LiveObstacles::clearance(const Vector2d& p_robot, double reach) const {
  double nearest = reach * reach;
  bool found = false;
  for (const Vector2d& point : points_) {
    const double squared = (point - p_robot).squaredNorm();
    if (squared > nearest) continue;
    nearest = squared;
    found = true;
  }
  return found ? std::sqrt(nearest) : std::numeric_limits<double>::infinity();
}

double LiveObstacles::free_way(const Vector2d& p_robot, double radius) const {
  const double length = p_robot.norm();
  const int steps = static_cast<int>(std::ceil(length / kStep));
  for (int k = 1; k <= steps; ++k) {
    if (!is_free(points_, p_robot * k / steps, radius)) return length * (k - 1) / steps;
  }
  return length;
}

double LiveObstacles::free_arc(double curvature, double radius, double reach) const {
  const int steps = static_cast<int>(std::ceil(reach / kStep));
  for (int k = 1; k <= steps; ++k) {
    const double along = reach * k / steps;
    const Vector2d p = exponential(Vector3d(along, 0, along * curvature)).translation();
    if (!is_free(points_, p, radius)) return reach * (k - 1) / steps;
  }
  return reach;
}

}  // namespace helicoid
