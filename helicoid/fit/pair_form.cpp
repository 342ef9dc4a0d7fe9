#include "helicoid/fit/pair_form.hpp"

#include <Eigen/Cholesky>

namespace helicoid {

Vector5d pair_vector(const Pose2& T_a_b) {
  Vector5d v;
  v << std::cos(T_a_b.yaw), std::sin(T_a_b.yaw), T_a_b.x, T_a_b.y, 1;
  return v;
}

Eigen::Matrix<double, 5, 3> pair_vector_jacobian(const Pose2& T_a_b) {
  Eigen::Matrix<double, 5, 3> J = Eigen::Matrix<double, 5, 3>::Zero();
  J(0, 2) = -std::sin(T_a_b.yaw);
  J(1, 2) = std::cos(T_a_b.yaw);
  J(2, 0) = 1;
  J(3, 1) = 1;
  return J;
}

double PairForm::cost(const Pose2& T_a_b) const {
  const Vector5d v = pair_vector(T_a_b);
  return 0.5 * v.dot(M * v);
}

Vector5d point_line_row(const Vector2d& p_b, const Vector2d& q_a, const Vector2d& n_a) {
  Vector5d g;
  g << n_a.dot(p_b), n_a.y() * p_b.x() - n_a.x() * p_b.y(), n_a.x(), n_a.y(), -n_a.dot(q_a);
  return g;
}

std::array<Vector5d, 2> point_point_rows(const Vector2d& p_b, const Vector2d& q_a) {
  return {point_line_row(p_b, q_a, Vector2d::UnitX()), point_line_row(p_b, q_a, Vector2d::UnitY())};
}

std::array<Vector5d, 3> line_line_rows(const LineSegment& line_b, const LineSegment& line_a) {
  const Vector2d& n_a = line_a.normal;
  const Vector2d& n_b = line_b.normal;
  // n_a x (R n_b), in the cosine and the sine of R.
  Vector5d sine = Vector5d::Zero();
  sine[0] = n_a.x() * n_b.y() - n_a.y() * n_b.x();
  sine[1] = n_a.dot(n_b);
  return {point_line_row(line_b.start, line_a.start, n_a), point_line_row(line_b.end, line_a.start, n_a), sine};
}

bool normals_agree(const Pose2& T_a_b, const LineSegment& line_b, const LineSegment& line_a) {
  return line_a.normal.dot(T_a_b.rotation() * line_b.normal) > 0;
}

PairForm pose_pose_form(const Pose2& T_a_b_measured, const Matrix3d& information) {
  Eigen::Matrix<double, 3, 5> G = Eigen::Matrix<double, 3, 5>::Zero();
  G(0, 2) = 1;
  G(0, 4) = -T_a_b_measured.x;
  G(1, 3) = 1;
  G(1, 4) = -T_a_b_measured.y;
  G(2, 0) = -std::sin(T_a_b_measured.yaw);
  G(2, 1) = std::cos(T_a_b_measured.yaw);
  PairForm form;
  form.M = G.transpose() * information * G;
  return form;
}

PairExpansion expand(const PairForm& form, const Pose2& T_a_b) {
  const Vector5d v = pair_vector(T_a_b);
  const Eigen::Matrix<double, 5, 3> J = pair_vector_jacobian(T_a_b);
  const Vector5d Mv = form.M * v;
  const Matrix3d information = J.transpose() * form.M * J;
  return {0.5 * v.dot(Mv), J.transpose() * Mv, 0.5 * (information + information.transpose())};
}

PairMinimum minimise(const PairForm& form, const Pose2& start) {
  constexpr int kMaxIterations = 20;
  PairMinimum best{start, form.cost(start), 0, false};
  for (; best.iterations < kMaxIterations && !best.converged; ++best.iterations) {
    const PairExpansion e = expand(form, best.T_a_b);
    // A trace of damping keeps a degenerate pair (a corridor) where it is instead of sending it to infinity.
    const Matrix3d damped = e.information + 1e-9 * (1 + e.information.trace()) * Matrix3d::Identity();
    Vector3d step = -damped.ldlt().solve(e.gradient);
    Pose2 next = Pose2::from_vector(best.T_a_b.vector() + step);
    double cost = form.cost(next);
    for (int halving = 0; halving < 8 && cost > best.cost; ++halving) {
      step *= 0.5;
      next = Pose2::from_vector(best.T_a_b.vector() + step);
      cost = form.cost(next);
    }
    best.converged = cost > best.cost || step.norm() < 1e-10;
    if (cost <= best.cost) {
      best.T_a_b = next;
      best.cost = cost;
    }
  }
  return best;
}

}  // namespace helicoid
