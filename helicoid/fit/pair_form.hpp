// A pair's relations, O(1) whatever their number (design 5.1). Residuals that are linear in
// v = (cos phi, sin phi, t_x, t_y, 1) of the relative pose T_a_b add up to 1/2 v^T M v with one symmetric 5 x 5 matrix.
#pragma once

#include <array>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

/// v(T_a_b).
[[nodiscard]] Vector5d pair_vector(const Pose2& T_a_b);
/// dv / d(t_x, t_y, phi), 5 x 3.
[[nodiscard]] Eigen::Matrix<double, 5, 3> pair_vector_jacobian(const Pose2& T_a_b);

/// An unknown that some residuals share beside the pose, each by a factor h of its own: (g . v + h u)^2.
struct SharedUnknown {
  Vector5d mixed = Vector5d::Zero();  ///< sum of weight * h * g
  double square = 0;                  ///< sum of weight * h^2

  void add(const Vector5d& g, double h, double weight) {
    mixed.noalias() += weight * h * g;
    square += weight * h * h;
  }
};

/// The sum of any number of correspondences between patches a and b: cost 1/2 v^T M v, dimensionless (chi^2 / 2).
struct PairForm {
  Matrix5d M = Matrix5d::Zero();

  /// Adds one residual (g . v)^2 with this weight (1 / variance).
  void add(const Vector5d& g, double weight) { M.noalias() += weight * g * g.transpose(); }
  /// Takes out what an unknown of this standard deviation explains as well: the cost at its best value for every pose
  /// (the Schur complement of the joint form). The residuals that share it have been added.
  void marginalise(const SharedUnknown& shared, double sigma) {
    M.noalias() -= shared.mixed * shared.mixed.transpose() / (shared.square + 1 / (sigma * sigma));
  }
  [[nodiscard]] double cost(const Pose2& T_a_b) const;
  friend bool operator==(const PairForm&, const PairForm&) = default;
};

/// g of a point-to-line correspondence (III-B): p_b must lie on the line through q_a with unit normal n_a.
[[nodiscard]] Vector5d point_line_row(const Vector2d& p_b, const Vector2d& q_a, const Vector2d& n_a);
/// The two g's of a point-to-point correspondence (eq. 7): along a's axes.
[[nodiscard]] std::array<Vector5d, 2> point_point_rows(const Vector2d& p_b, const Vector2d& q_a);

/// A stretch of a wall as a patch sees it, metres, in the patch's frame.
struct LineSegment {
  Vector2d start = Vector2d::Zero();
  Vector2d end = Vector2d::Zero();
  Vector2d normal = Vector2d::UnitY();  ///< unit, towards the side it was seen from
};
/// The three g's of a line-to-line correspondence (III-B): both ends of b's segment on a's line, metres, and the sine
/// of the angle between the lines. A sine does not tell a wall from its back: ask `normals_agree` before.
[[nodiscard]] std::array<Vector5d, 3> line_line_rows(const LineSegment& line_b, const LineSegment& line_a);
/// Whether both were seen from the same side, as T_a_b has it.
[[nodiscard]] bool normals_agree(const Pose2& T_a_b, const LineSegment& line_b, const LineSegment& line_a);

/// The pose-pose relation (t - t_measured, sin(phi - phi_measured)), linear in v as well; information in a's frame.
[[nodiscard]] PairForm pose_pose_form(const Pose2& T_a_b_measured, const Matrix3d& information);

/// Cost, gradient and Gauss-Newton Hessian by the parameters (t_x, t_y, phi) of T_a_b. The Hessian is positive
/// semi-definite: the expected information of eq. 9.
struct PairExpansion {
  double cost = 0;
  Vector3d gradient = Vector3d::Zero();
  Matrix3d information = Matrix3d::Zero();
};
[[nodiscard]] PairExpansion expand(const PairForm& form, const Pose2& T_a_b);

/// The pose that minimises the form, from a start; Gauss-Newton with step halving.
struct PairMinimum {
  Pose2 T_a_b;
  double cost = 0;  ///< c_min / 2: what is left of 1/2 v^T M v
  int iterations = 0;
  bool converged = false;
};
[[nodiscard]] PairMinimum minimise(const PairForm& form, const Pose2& start);

}  // namespace helicoid
