// Where the robot should be by its odometry, and how much that is worth. Odometry has heavy tails and no data sheet:
// its scale is learned per robot from how far the matches moved the predictions (design 5.4).
#pragma once

#include <optional>

#include "helicoid/align/align_scan.hpp"
#include "helicoid/sensor/event.hpp"

namespace helicoid {

struct MotionLimits {
  double speed = 2;        ///< no robot is faster, metres / second
  double turn_rate = 2.5;  ///< radians / second
  double slack = 0.1;      ///< added to the time between scans: stamps are jittery, seconds
};

/// The increment between two scans of one robot.
struct Motion {
  Pose2 T_last_now;
  bool measured = true;  ///< false: no odometry, or an impossible step; constant velocity instead
  bool impossible = false;
  Pose2 T_last_now_odometry;  ///< the step as odometry has it, where it has one: possible or not
};

/// By how much a robot's odometry counts its metres short or long, as its matches have it: tyres wear, and a floor's
/// give is no tape measure. Where matches tell nothing of the way, they say that odometry is right.
class OdometryGain {
 public:
  [[nodiscard]] Pose2 corrected(const Pose2& step) const;
  void learn(const Pose2& step, const Pose2& matched);
  [[nodiscard]] double gain() const;

 private:
  double way_ = 0, too_short_ = 0;  ///< metres
};

class MotionPrior {
 public:
  explicit MotionPrior(const MotionLimits& limits = {}) : limits_(limits) {}

  /// The motion since the last scan; call once a scan, in order.
  Motion advance(const Scan& scan, double stamp);
  /// What the match made of it: the innovation scales the next priors.
  void learn(const Motion& predicted, const Pose2& T_last_now_matched);
  /// True if this motion is not to be taken on trust: the last match contradicted the odometry, or a robot that drove
  /// has all at once not moved: some odometry stands still for a few scans and makes up for them in one step.
  [[nodiscard]] bool is_doubtful(const Motion& motion) const;
  /// What else it may have been: the last matched motion once more, or the step that is thought impossible. Nothing
  /// without odometry.
  [[nodiscard]] std::optional<Motion> alternative(const Motion& motion) const;
  /// How well this motion is known: of T_last_now.
  [[nodiscard]] Matrix3d covariance(const Motion& motion) const;
  /// Information about the raw motion between two kept patches that lie this far apart along the path.
  [[nodiscard]] Matrix3d path_information(double path, double turn) const;

 private:
  [[nodiscard]] Vector3d sigma(double path, double turn) const;

  MotionLimits limits_;
  bool has_last_ = false;
  Pose2 T_odom_last_;
  double last_stamp_ = 0;
  OdometryGain gain_;
  Pose2 velocity_;  ///< the last matched motion
  bool in_doubt_ = false;
  double scale_ = 1;  ///< squared: innovations over what sigma() says
};

}  // namespace helicoid
