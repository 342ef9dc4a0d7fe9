#include "helicoid/mapping/motion_prior.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

// Where to begin before a robot's own innovations are known.
constexpr double kPositionNoise = 0.01;  // metres, standing
constexpr double kPositionPerMetre = 0.10;
constexpr double kPositionPerRadian = 0.02;  // metres per radian
constexpr double kHeadingNoise = 0.01;       // radians, standing
constexpr double kHeadingPerRadian = 0.15;
constexpr double kHeadingPerMetre = 0.06;  // radians per metre
constexpr double kDriving = 0.05;          // metres from scan to scan: a robot that drives
constexpr double kStopped = 0.2;           // and has all at once stopped: this part of it
constexpr double kUnmeasuredFactor = 5;    // constant velocity is worth this much less
// How a robot's odometry counts metres.
constexpr double kDoubt = 20;    // metres of way that speak for its being right
constexpr double kMemory = 300;  // metres
constexpr double kMost = 0.3;    // one step tells no more, metres

}  // namespace

Pose2 OdometryGain::corrected(const Pose2& step) const {
  return {gain() * step.x, gain() * step.y, step.yaw};
}

double OdometryGain::gain() const {
  return 1 + too_short_ / (way_ + kDoubt);
}

void OdometryGain::learn(const Pose2& step, const Pose2& matched) {
  const double way = std::abs(step.x);
  const double kept = std::max(0.0, 1 - way / kMemory);
  way_ = kept * way_ + way;
  too_short_ = kept * too_short_ + std::copysign(1.0, step.x) * std::clamp(matched.x - step.x, -kMost, kMost);
}

Motion MotionPrior::advance(const Scan& scan, double stamp) {
  Motion motion;
  // Stamps that stand still or step back tell no time: a usual interval then.
  const double elapsed = (stamp > last_stamp_ ? std::min(stamp - last_stamp_, 10.0) : 0.3) + limits_.slack;
  if (!scan.has_odometry) {
    motion.T_last_now = velocity_;
    motion.measured = false;
  } else if (has_last_) {
    motion.T_last_now_odometry = T_odom_last_.inverse() * scan.T_odom_robot;
    motion.T_last_now = gain_.corrected(motion.T_last_now_odometry);
    if (motion.T_last_now.distance() > limits_.speed * elapsed ||
        std::abs(motion.T_last_now.yaw) > limits_.turn_rate * elapsed) {
      motion.T_last_now = velocity_;
      motion.measured = false;
      motion.impossible = true;
    }
  }
  has_last_ = scan.has_odometry;
  T_odom_last_ = scan.T_odom_robot;
  last_stamp_ = stamp;
  return motion;
}

bool MotionPrior::is_doubtful(const Motion& motion) const {
  if (in_doubt_ || motion.impossible) return true;
  const double before = velocity_.distance();
  return motion.measured && before > kDriving && motion.T_last_now.distance() < kStopped * before;
}

std::optional<Motion> MotionPrior::alternative(const Motion& motion) const {
  if (!motion.measured && !motion.impossible) return std::nullopt;
  Motion other = motion;
  other.measured = false;
  other.T_last_now = motion.impossible ? motion.T_last_now_odometry : velocity_;
  return other;
}

Vector3d MotionPrior::sigma(double path, double turn) const {
  const double position = kPositionNoise + kPositionPerMetre * path + kPositionPerRadian * turn;
  const double heading = kHeadingNoise + kHeadingPerRadian * turn + kHeadingPerMetre * path;
  return std::sqrt(scale_) * Vector3d(position, position, heading);
}

Matrix3d MotionPrior::covariance(const Motion& motion) const {
  const Vector3d s =
      sigma(motion.T_last_now.distance(), std::abs(motion.T_last_now.yaw)) * (motion.measured ? 1 : kUnmeasuredFactor);
  return s.cwiseAbs2().asDiagonal();
}

Matrix3d MotionPrior::path_information(double path, double turn) const {
  // Never more than a match is worth: it matters along degenerate directions only.
  const Vector3d s = sigma(path, turn).cwiseMax(Vector3d(0.05, 0.05, 0.05));
  return s.cwiseAbs2().cwiseInverse().asDiagonal();
}

void MotionPrior::learn(const Motion& predicted, const Pose2& T_last_now_matched) {
  velocity_ = T_last_now_matched;
  if (!predicted.measured) return;
  gain_.learn(predicted.T_last_now_odometry, T_last_now_matched);
  const Pose2 innovation = predicted.T_last_now.inverse() * T_last_now_matched;
  const Vector3d s = sigma(predicted.T_last_now.distance(), std::abs(predicted.T_last_now.yaw));
  const double ratio = scale_ * innovation.vector().cwiseQuotient(s).squaredNorm() / 3;
  in_doubt_ = ratio > 6;
  // One wild step must not open the gate for a minute.
  scale_ = std::clamp(scale_ + 0.02 * (std::min(ratio, 25.0) - scale_), 0.25, 25.0);
}

}  // namespace helicoid
