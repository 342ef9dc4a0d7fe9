#include "helicoid/navigation/moving_obstacles.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/navigation/live_obstacles.hpp"
#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

namespace {

constexpr double kReach = 2.5;         // beyond this nothing is looked at, metres
constexpr double kLookBack = 0.4;      // to the view that is compared with, seconds
constexpr double kBeyond = 0.12;       // that a beam goes on behind what it is said to see through, metres
constexpr double kLeastStep = 0.05;    // towards the robot that is told from noise, metres
constexpr double kLongestStep = 0.35;  // what is farther behind is what it hides, metres
constexpr double kBeside = 0.06;       // so far on either side beams do the same, metres
constexpr double kOneThing = 0.3;      // between points of one thing at most, metres
constexpr double kSize = 0.8;          // of one thing, metres
constexpr std::size_t kPoints = 3;     // make a thing

/// Runs of points that lie near one another.
std::vector<std::vector<Vector2d>> runs_of(std::span<const Vector2d> points) {
  std::vector<std::vector<Vector2d>> runs;
  for (const Vector2d& p : points) {
    if (runs.empty() || (p - runs.back().back()).norm() > kOneThing) runs.emplace_back();
    runs.back().push_back(p);
  }
  std::erase_if(runs, [](const std::vector<Vector2d>& run) { return run.size() < kPoints; });
  return runs;
}

Vector2d mean_of(std::span<const Vector2d> points) {
  Vector2d sum = Vector2d::Zero();
  for (const Vector2d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// From what it has left to what it has come into.
Vector2d direction_of(const Vector2d& p_into, std::span<const Vector2d> left) {
  std::vector<Vector2d> near;
  std::copy_if(left.begin(), left.end(), std::back_inserter(near),
               [&](const Vector2d& p) { return (p - p_into).norm() < kSize; });
  if (near.empty()) return Vector2d::Zero();
  const Vector2d moved = p_into - mean_of(near);
  return moved.norm() > 1e-9 ? Vector2d(moved.normalized()) : Vector2d(Vector2d::Zero());
}

/// Between beams it has a fraction; outside of the field of view it is less than the first, or more than the last.
double beam_towards(const Vector2d& p_laser, const LaserModel& laser) {
  const double middle = laser.first_bearing + 0.5 * laser.field_of_view();
  const double off = wrap_angle(std::atan2(p_laser.y(), p_laser.x()) - middle);
  return 0.5 * (laser.beams - 1) + off / laser.bearing_step;
}

}  // namespace

/// All beams about it go on behind it; what does not come back has not met anything.
bool MovingObstacles::View::sees_through(const Vector2d& p_odom, const LaserModel& laser) const {
  const Vector2d p_laser = T_odom_laser.inverse() * p_odom;
  const double distance = p_laser.norm();
  const double middle = beam_towards(p_laser, laser);
  const double beside = std::max(2.0, std::atan2(kBeside, distance) / laser.bearing_step);
  const auto first = static_cast<int>(std::floor(middle - beside));
  const auto last = static_cast<int>(std::ceil(middle + beside));
  if (first < 0 || last >= static_cast<int>(ranges.size())) return false;
  return std::all_of(ranges.begin() + first, ranges.begin() + last + 1, [&](float range) {
    return !is_return(range, laser) || static_cast<double>(range) > distance + kBeyond;
  });
}

/// What stood there has left, or has come nearer.
bool MovingObstacles::View::sees_gone(const Vector2d& p_odom, const LaserModel& laser) const {
  if (sees_through(p_odom, laser)) return true;
  const Vector2d p_laser = T_odom_laser.inverse() * p_odom;
  const double beam = std::round(beam_towards(p_laser, laser));
  if (beam < 0 || beam >= static_cast<double>(ranges.size())) return false;
  const float range = ranges[static_cast<std::size_t>(beam)];
  const double nearer = p_laser.norm() - static_cast<double>(range);
  return is_return(range, laser) && nearer > kLeastStep && nearer < kLongestStep;
}

void MovingObstacles::see(const Scan& scan, const LaserModel& laser, double dt) {
  all_.clear();
  if (!scan.has_odometry || laser.bearing_step == 0) return views_.clear();
  for (View& view : views_) view.age += dt;
  views_.push_back({scan.T_odom_robot * scan.T_robot_laser, scan.ranges, 0});
  while (views_.size() > 2 && views_[1].age >= kLookBack) views_.pop_front();
  const View& before = views_.front();
  const View& now = views_.back();
  if (before.age < 0.5 * kLookBack || before.age > 2 * kLookBack) return;
  std::vector<Vector2d> left = surfaces_within(kReach, before.ranges, laser, before.T_odom_laser);
  std::erase_if(left, [&](const Vector2d& p) { return !now.sees_gone(p, laser); });
  std::vector<Vector2d> into = surfaces_within(kReach, now.ranges, laser, now.T_odom_laser);
  std::erase_if(into, [&](const Vector2d& p) { return !before.sees_through(p, laser); });
  const Pose2 T_robot_odom = scan.T_odom_robot.inverse();
  const Pose2 turned{0, 0, T_robot_odom.yaw};
  for (const std::vector<Vector2d>& run : runs_of(into)) {
    const Vector2d p_odom = *std::min_element(run.begin(), run.end(), [&](const Vector2d& a, const Vector2d& b) {
      return (T_robot_odom * a).squaredNorm() < (T_robot_odom * b).squaredNorm();
    });
    all_.push_back({T_robot_odom * p_odom, turned * direction_of(mean_of(run), left)});
  }
}

}  // namespace helicoid
