#include "helicoid/mapping/driven_way.hpp"

#include <Eigen/LU>
#include <cmath>

namespace helicoid {

void DrivenWay::add(const Pose2& step) {
  T_from_robot = T_from_robot * step;
  path += step.distance();
  turn += std::abs(step.yaw);
}

UncertainPose2 DrivenWay::end(const MotionPrior& motion) const {
  return compound({from.T_patch_robot, covariance}, {T_from_robot, motion.path_information(path, turn).inverse()});
}

}  // namespace helicoid
