#include "helicoid/eval/trajectory_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace helicoid {

Pose2 align_points(std::span<const Vector2d> points, std::span<const Vector2d> targets) {
  Vector2d mean_p = Vector2d::Zero();
  Vector2d mean_t = Vector2d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    mean_p += points[i] / static_cast<double>(points.size());
    mean_t += targets[i] / static_cast<double>(points.size());
  }
  double along = 0;
  double across = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d p = points[i] - mean_p;
    const Vector2d t = targets[i] - mean_t;
    along += p.dot(t);
    across += p.x() * t.y() - p.y() * t.x();
  }
  Pose2 T{0, 0, std::atan2(across, along)};
  const Vector2d offset = mean_t - T * mean_p;
  return {offset.x(), offset.y(), T.yaw};
}

namespace {

/// A pose with its true one.
struct Pair {
  double stamp;
  Pose2 pose, truth;
};

/// Each pose with the true one nearest in time, if that is within the tolerance.
std::vector<Pair> pair_up(std::span<const double> stamps, std::span<const Pose2> poses,
                          std::span<const double> true_stamps, std::span<const Pose2> truth, double tolerance) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    auto at = std::lower_bound(true_stamps.begin(), true_stamps.end(), stamps[i]) - true_stamps.begin();
    if (at > 0 && (at == std::ssize(true_stamps) || stamps[i] - true_stamps[at - 1] < true_stamps[at] - stamps[i]))
      --at;
    if (at == std::ssize(true_stamps) || std::abs(true_stamps[at] - stamps[i]) > tolerance) continue;
    pairs.push_back({stamps[i], poses[i], truth[at]});
  }
  return pairs;
}

double absolute_error(std::span<const Pair> pairs) {
  std::vector<Vector2d> from;
  std::vector<Vector2d> to;
  for (const Pair& p : pairs) {
    from.push_back(p.pose.translation());
    to.push_back(p.truth.translation());
  }
  const Pose2 T_truth_estimate = align_points(from, to);
  double squares = 0;
  for (std::size_t i = 0; i < from.size(); ++i) squares += (T_truth_estimate * from[i] - to[i]).squaredNorm();
  return std::sqrt(squares / static_cast<double>(from.size()));
}

void add_relative_error(std::span<const Pair> pairs, double interval, TrajectoryError& error) {
  double translations = 0;
  double rotations = 0;
  std::size_t count = 0;
  for (std::size_t i = 0, j = 0; i < pairs.size(); ++i) {
    while (j < pairs.size() && pairs[j].stamp < pairs[i].stamp + interval) ++j;
    if (j == pairs.size()) break;
    const Pose2 off = (pairs[i].truth.inverse() * pairs[j].truth).inverse() * (pairs[i].pose.inverse() * pairs[j].pose);
    translations += off.translation().squaredNorm();
    rotations += off.yaw * off.yaw;
    ++count;
  }
  if (count == 0) return;
  error.rpe_m = std::sqrt(translations / static_cast<double>(count));
  error.rpe_deg = degrees(std::sqrt(rotations / static_cast<double>(count)));
}

}  // namespace

TrajectoryError trajectory_error(std::span<const double> stamps, std::span<const Pose2> poses,
                                 std::span<const double> true_stamps, std::span<const Pose2> truth, double tolerance,
                                 double interval) {
  const std::vector<Pair> pairs = pair_up(stamps, poses, true_stamps, truth, tolerance);
  TrajectoryError error;
  error.matched = pairs.size();
  if (pairs.empty()) return error;
  error.ate_m = absolute_error(pairs);
  add_relative_error(pairs, interval, error);
  return error;
}

}  // namespace helicoid
