// SE(2): poses in the plane and the paper's two operators. Lengths in metres, angles in radians.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace helicoid {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// The equal angle in [-pi, pi).
[[nodiscard]] double wrap_angle(double angle);

[[nodiscard]] constexpr double degrees(double radians) {
  return radians * (180 / std::numbers::pi);
}
[[nodiscard]] constexpr double radians(double degrees) {
  return degrees * (std::numbers::pi / 180);
}

/// A rigid transform of the plane. `T_a_b` takes coordinates in frame b to frame a; as a pose it is where b
/// stands in a. The yaw is kept within [-pi, pi) by composition and inversion.
struct Pose2 {
  double x = 0;    ///< metres
  double y = 0;    ///< metres
  double yaw = 0;  ///< radians, anticlockwise

  [[nodiscard]] Vector2d translation() const { return {x, y}; }
  [[nodiscard]] Vector3d vector() const { return {x, y, yaw}; }
  [[nodiscard]] static Pose2 from_vector(const Vector3d& v) { return {v[0], v[1], wrap_angle(v[2])}; }
  [[nodiscard]] double distance() const { return std::hypot(x, y); }
  [[nodiscard]] Matrix2d rotation() const;
  [[nodiscard]] Pose2 inverse() const;
  friend bool operator==(const Pose2&, const Pose2&) = default;
};

/// T_a_c = T_a_b * T_b_c.
[[nodiscard]] Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c);
/// p_a = T_a_b * p_b.
[[nodiscard]] Vector2d operator*(const Pose2& T_a_b, const Vector2d& p_b);

/// The paper's r (+) theta (III-A): the projected pose of r, which is given relative to the patch at theta.
[[nodiscard]] inline Pose2 oplus(const Pose2& r, const Pose2& theta) {
  return theta * r;
}
/// The paper's q (-) theta (III-A): the pose relative to the patch at theta of what projects to q.
[[nodiscard]] inline Pose2 ominus(const Pose2& q, const Pose2& theta) {
  return theta.inverse() * q;
}

/// The exponential of SE(2): where a body with the constant twist (v_x, v_y, omega), in its own frame, is after one
/// unit of time.
[[nodiscard]] Pose2 exponential(const Vector3d& twist);
/// Its inverse: the constant twist that leads to this pose in one unit of time, by the shorter turn.
[[nodiscard]] Vector3d logarithm(const Pose2& pose);

/// T_a_c = T_a_b * T_b_c with its derivatives by the parameters (x, y, yaw) of either factor; 3 x 3 each.
struct Composition {
  Pose2 T_a_c;
  Matrix3d by_first;
  Matrix3d by_second;
};
[[nodiscard]] Composition compose_with_jacobians(const Pose2& T_a_b, const Pose2& T_b_c);

/// T_b_a with its derivative by the parameters (x, y, yaw) of T_a_b; 3 x 3.
struct Inversion {
  Pose2 T_b_a;
  Matrix3d by_pose;
};
[[nodiscard]] Inversion invert_with_jacobian(const Pose2& T_a_b);

}  // namespace helicoid
