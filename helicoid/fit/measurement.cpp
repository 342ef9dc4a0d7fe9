#include "helicoid/fit/measurement.hpp"

namespace helicoid {

namespace {

/// A scalar residual e with weight 1 / sigma^2 and derivative J.
PairExpansion of_scalar(double e, const Vector3d& J, double sigma) {
  const double weight = 1 / (sigma * sigma);
  return {0.5 * weight * e * e, weight * e * J, weight * J * J.transpose()};
}

/// d = T_a_b p_b - p_a, and the derivative of it by phi.
struct Offset {
  Vector2d d;
  Vector2d by_yaw;
};
Offset offset_of(const Vector2d& p_a, const Vector2d& p_b, const RelativePose& T) {
  const Vector2d turned(T.cosine * p_b.x() - T.sine * p_b.y(), T.sine * p_b.x() + T.cosine * p_b.y());
  return {Vector2d(T.x, T.y) + turned - p_a, Vector2d(-turned.y(), turned.x())};
}

struct Expand {
  const RelativePose& T;

  PairExpansion operator()(const PosePose& m) const {
    const double c = std::cos(m.T_a_b.yaw);
    const double s = std::sin(m.T_a_b.yaw);
    const double dx = T.x - m.T_a_b.x;
    const double dy = T.y - m.T_a_b.y;
    const Vector3d e(c * dx + s * dy, c * dy - s * dx, wrap_small(T.yaw - m.T_a_b.yaw));
    Matrix3d J = Matrix3d::Identity();
    J.topLeftCorner<2, 2>() << c, s, -s, c;
    const Vector3d We = m.information * e;
    return {0.5 * e.dot(We), J.transpose() * We, J.transpose() * m.information * J};
  }

  PairExpansion operator()(const Correspondences& m) const {
    Vector5d v;
    v << T.cosine, T.sine, T.x, T.y, 1;
    Eigen::Matrix<double, 5, 3> J = Eigen::Matrix<double, 5, 3>::Zero();
    J(0, 2) = -T.sine;
    J(1, 2) = T.cosine;
    J(2, 0) = 1;
    J(3, 1) = 1;
    const Vector5d Mv = m.form->M * v;
    const Matrix3d W = J.transpose() * m.form->M * J;
    return {m.scale * 0.5 * v.dot(Mv), m.scale * (J.transpose() * Mv), m.scale * 0.5 * (W + W.transpose())};
  }

  PairExpansion operator()(const RelativeRange& m) const {
    const Offset o = offset_of(m.p_a, m.p_b, T);
    const double distance = o.d.norm();
    const Vector2d n = distance > 1e-9 ? Vector2d(o.d / distance) : Vector2d::Zero();
    return of_scalar(distance - m.range, Vector3d(n.x(), n.y(), n.dot(o.by_yaw)), m.sigma);
  }

  PairExpansion operator()(const RelativeBearing& m) const {
    const Offset o = offset_of(m.p_a, m.p_b, T);
    const double square = o.d.squaredNorm();
    const Vector2d n = square > 1e-18 ? Vector2d(Vector2d(-o.d.y(), o.d.x()) / square) : Vector2d::Zero();
    const double e = wrap_angle(std::atan2(o.d.y(), o.d.x()) - m.bearing);
    return of_scalar(e, Vector3d(n.x(), n.y(), n.dot(o.by_yaw)), m.sigma);
  }

  PairExpansion operator()(const PointPosition& m) const {
    const Vector2d e = Vector2d(T.x, T.y) - m.p_a;
    const Vector2d We = m.information * e;
    PairExpansion result{0.5 * e.dot(We), Vector3d(We.x(), We.y(), 0), Matrix3d::Zero()};
    result.information.topLeftCorner<2, 2>() = m.information;
    return result;
  }
};

}  // namespace

RelativePose RelativePose::of(const Pose2& T_a_b) {
  return {T_a_b.x, T_a_b.y, T_a_b.yaw, std::cos(T_a_b.yaw), std::sin(T_a_b.yaw)};
}

double wrap_small(double angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  while (angle > std::numbers::pi) angle -= kTurn;
  while (angle < -std::numbers::pi) angle += kTurn;
  return angle;
}

PairExpansion expand(const Measurement& measurement, const RelativePose& T_a_b) {
  return std::visit(Expand{T_a_b}, measurement);
}

double cost(const Measurement& measurement, const RelativePose& T_a_b) {
  return expand(measurement, T_a_b).cost;
}

}  // namespace helicoid
