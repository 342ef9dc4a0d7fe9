// What one relation adds to the linear system (eq. 8-9): its expansion by the relative pose, taken to the twists xi of
// its two nodes, theta <- theta exp(xi).
#pragma once

#include <algorithm>

#include "helicoid/fit/relation_graph.hpp"
#include "helicoid/fit/robust_loss.hpp"

namespace helicoid {

/// Expected information and gradient by the twists of a and b; chi^2 / 2, metres and radians in each node's own frame.
struct TieBlocks {
  Matrix3d aa, bb;
  Matrix3d ab;  ///< row a, column b
  Vector3d a, b;
};

/// M J for the derivative J = [-1 0 y; 0 -1 -x; 0 0 -1] of (t_x, t_y, phi) by the twist of a.
[[nodiscard]] inline Matrix3d times_by_first(const Matrix3d& M, const RelativePose& T) {
  Matrix3d result;
  for (int i = 0; i < 3; ++i) {
    result(i, 0) = -M(i, 0);
    result(i, 1) = -M(i, 1);
    result(i, 2) = T.y * M(i, 0) - T.x * M(i, 1) - M(i, 2);
  }
  return result;
}

/// And for that by the twist of b, [c -s 0; s c 0; 0 0 1].
[[nodiscard]] inline Matrix3d times_by_second(const Matrix3d& M, const RelativePose& T) {
  Matrix3d result;
  for (int i = 0; i < 3; ++i) {
    result(i, 0) = T.cosine * M(i, 0) + T.sine * M(i, 1);
    result(i, 1) = T.cosine * M(i, 1) - T.sine * M(i, 0);
    result(i, 2) = M(i, 2);
  }
  return result;
}

[[nodiscard]] inline TieBlocks tie_blocks(const PairExpansion& pair, const RelativePose& T_a_b) {
  // J^T M = (M^T J)^T, and the information is symmetric.
  const Matrix3d W_a = times_by_first(pair.information, T_a_b);
  const Matrix3d W_b = times_by_second(pair.information, T_a_b);
  const Vector3d& g = pair.gradient;
  return {times_by_first(W_a.transpose(), T_a_b), times_by_second(W_b.transpose(), T_a_b),
          times_by_second(W_a.transpose(), T_a_b), Vector3d(-g[0], -g[1], T_a_b.y * g[0] - T_a_b.x * g[1] - g[2]),
          Vector3d(T_a_b.cosine * g[0] + T_a_b.sine * g[1], T_a_b.cosine * g[1] - T_a_b.sine * g[0], g[2])};
}

/// Of a node that has no heading.
inline void drop_heading(Matrix3d& H, Vector3d& g) {
  H.row(2).setZero();
  H.col(2).setZero();
  g[2] = 0;
}

/// The loss on the excess over what the relation costs at its best.
inline void soften(const GraphRelation& r, const RobustLoss& loss, PairExpansion& pair) {
  if (loss.kind == LossKind::quadratic || !r.may_be_wrong) return;
  const auto* form = std::get_if<Correspondences>(&r.measurement);
  const double least = form != nullptr ? form->scale * form->least_cost : 0;
  const Loss softened = evaluate(loss, std::max(0.0, 2 * (pair.cost - least)));
  pair.cost = least + 0.5 * softened.value;
  pair.gradient *= softened.weight;
  pair.information *= softened.weight;
}

}  // namespace helicoid
