#include "helicoid/geometry/covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace helicoid {

Matrix3d transport(const Matrix3d& jacobian, const Matrix3d& covariance) {
  const Matrix3d moved = jacobian * covariance * jacobian.transpose();
  return 0.5 * (moved + moved.transpose());
}

Matrix3d turned(const Matrix3d& covariance, double yaw) {
  Matrix3d turn = Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Pose2{0, 0, yaw}.rotation();
  return transport(turn, covariance);
}

UncertainPose2 compound(const UncertainPose2& ab, const UncertainPose2& bc) {
  const Composition c = compose_with_jacobians(ab.T_a_b, bc.T_a_b);
  return {c.T_a_c, transport(c.by_first, ab.covariance) + transport(c.by_second, bc.covariance)};
}

UncertainPose2 invert(const UncertainPose2& ab) {
  const Inversion inverse = invert_with_jacobian(ab.T_a_b);
  return {inverse.T_b_a, transport(inverse.by_pose, ab.covariance)};
}

double disagreement(const UncertainPose2& first, const UncertainPose2& second) {
  const Vector3d off(first.T_a_b.x - second.T_a_b.x, first.T_a_b.y - second.T_a_b.y,
                     wrap_angle(first.T_a_b.yaw - second.T_a_b.yaw));
  return off.dot((first.covariance + second.covariance).ldlt().solve(off));
}

ConfidenceInterval confidence_interval(const Matrix3d& covariance) {
  const double xx = covariance(0, 0);
  const double yy = covariance(1, 1);
  const double xy = covariance(0, 1);
  const double off = 0.5 * (xx - yy);
  const double largest = 0.5 * (xx + yy) + std::sqrt(off * off + xy * xy);
  return {1.96 * std::sqrt(std::max(0.0, largest)), 1.96 * std::sqrt(std::max(0.0, covariance(2, 2)))};
}

}  // namespace helicoid
