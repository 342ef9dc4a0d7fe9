// Covariances of relative poses: of the parameters (x, y, yaw) of T_a_b, so of a displacement in a's frame.
// They do not turn with the plane. Units m^2, m rad, rad^2. (Smith, Self and Cheeseman 1990.)
#pragma once

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// A relative pose that is known up to a covariance.
struct UncertainPose2 {
  Pose2 T_a_b;
  Matrix3d covariance = Matrix3d::Zero();  ///< of (x, y, yaw) of T_a_b
};

/// T_a_c from independent T_a_b and T_b_c.
[[nodiscard]] UncertainPose2 compound(const UncertainPose2& ab, const UncertainPose2& bc);
/// T_b_a from T_a_b.
[[nodiscard]] UncertainPose2 invert(const UncertainPose2& ab);
/// J C J^T made exactly symmetric.
[[nodiscard]] Matrix3d transport(const Matrix3d& jacobian, const Matrix3d& covariance);
/// The covariance of (x, y, yaw) with its axes turned by `yaw`.
[[nodiscard]] Matrix3d turned(const Matrix3d& covariance, double yaw);
/// chi^2 (three degrees of freedom) of the difference of two independent statements about one relative pose, neither of
/// them certain.
[[nodiscard]] double disagreement(const UncertainPose2& first, const UncertainPose2& second);

/// How well a relative pose is known: two numbers, never one mixed (design 5.3; eq. 10 with c = 1.96).
struct ConfidenceInterval {
  double position = 0;  ///< 1.96 sqrt(largest eigenvalue of the position block), metres
  double heading = 0;   ///< 1.96 sigma of the yaw, radians
};
[[nodiscard]] ConfidenceInterval confidence_interval(const Matrix3d& covariance);

}  // namespace helicoid
