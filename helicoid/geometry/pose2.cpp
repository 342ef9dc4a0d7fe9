#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

double wrap_angle(double angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  if (angle >= -std::numbers::pi && angle < std::numbers::pi) return angle;
  const double wrapped = angle - kTurn * std::floor((angle + std::numbers::pi) / kTurn);
  // Rounding can land on +pi itself.
  return wrapped >= std::numbers::pi ? -std::numbers::pi : wrapped;
}

Matrix2d Pose2::rotation() const {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  Matrix2d R;
  R << c, -s, s, c;
  return R;
}

Pose2 Pose2::inverse() const {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {-c * x - s * y, s * x - c * y, wrap_angle(-yaw)};
}

Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  return {T_a_b.x + c * T_b_c.x - s * T_b_c.y, T_a_b.y + s * T_b_c.x + c * T_b_c.y, wrap_angle(T_a_b.yaw + T_b_c.yaw)};
}

Vector2d operator*(const Pose2& T_a_b, const Vector2d& p_b) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  return {T_a_b.x + c * p_b.x() - s * p_b.y(), T_a_b.y + s * p_b.x() + c * p_b.y()};
}

Pose2 exponential(const Vector3d& twist) {
  const double omega = twist[2];
  const double square = omega * omega;
  // sin(w)/w and (1-cos(w))/w; the series where the quotients lose their digits.
  const double a = square < 1e-8 ? 1 - square / 6 : std::sin(omega) / omega;
  const double b = square < 1e-8 ? 0.5 * omega : (1 - std::cos(omega)) / omega;
  return {a * twist[0] - b * twist[1], b * twist[0] + a * twist[1], wrap_angle(omega)};
}

Vector3d logarithm(const Pose2& pose) {
  const double half = 0.5 * wrap_angle(pose.yaw);
  // w/2 cot(w/2); the series where the quotient loses its digits.
  const double a = half * half < 1e-8 ? 1 - half * half / 3 : half / std::tan(half);
  return {a * pose.x + half * pose.y, a * pose.y - half * pose.x, 2 * half};
}

Composition compose_with_jacobians(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  Composition result{T_a_b * T_b_c, Matrix3d::Identity(), Matrix3d::Identity()};
  result.by_first(0, 2) = -s * T_b_c.x - c * T_b_c.y;
  result.by_first(1, 2) = c * T_b_c.x - s * T_b_c.y;
  result.by_second.topLeftCorner<2, 2>() = T_a_b.rotation();
  return result;
}

Inversion invert_with_jacobian(const Pose2& T_a_b) {
  Inversion result{T_a_b.inverse(), Matrix3d::Zero()};
  result.by_pose.topLeftCorner<2, 2>() = -T_a_b.rotation().transpose();
  result.by_pose(0, 2) = result.T_b_a.y;
  result.by_pose(1, 2) = -result.T_b_a.x;
  result.by_pose(2, 2) = -1;
  return result;
}

}  // namespace helicoid
