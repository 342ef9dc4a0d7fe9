// What odometry has to say since a place that the map knows.
#pragma once

#include "helicoid/geometry/covariance.hpp"
#include "helicoid/manifold/trajectory.hpp"
#include "helicoid/mapping/motion_prior.hpp"

namespace helicoid {

struct DrivenWay {
  DrivenWay() = default;
  explicit DrivenWay(const ManifoldPose& start, const Matrix3d& known = Matrix3d::Zero())
      : from(start), covariance(known) {}

  ManifoldPose from;                       ///< where it began
  Matrix3d covariance = Matrix3d::Zero();  ///< of that place on its patch
  Pose2 T_from_robot;                      ///< by odometry alone
  double path = 0;                         ///< along it, metres
  double turn = 0;                         ///< radians

  void add(const Pose2& step);
  /// The robot's pose on the patch where the way began, and how well odometry knows it.
  [[nodiscard]] UncertainPose2 end(const MotionPrior& motion) const;
};

}  // namespace helicoid
