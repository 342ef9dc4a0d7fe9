#include "apps/experiments/false_closures.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace helicoid {

bool is_beyond_said(const UncertainPose2& said, const Pose2& truth) {
  // In the first's frame, as the covariance.
  const Vector3d off(said.T_a_b.x - truth.x, said.T_a_b.y - truth.y, wrap_angle(said.T_a_b.yaw - truth.yaw));
  return off.dot(said.covariance.ldlt().solve(off)) > kFalseByChi2;
}

bool is_false(const SimulatedRun& run, const Hypothesis& h) {
  const Pose2 truth = run.T_world_patch(h.a).inverse() * run.T_world_patch(h.b);
  const Pose2 apart = truth.inverse() * h.T_a_b.T_a_b;
  if (apart.distance() <= kFalseBy && std::abs(apart.yaw) <= kFalseByTurn) return false;
  return is_beyond_said(h.T_a_b, truth);
}

}  // namespace helicoid
