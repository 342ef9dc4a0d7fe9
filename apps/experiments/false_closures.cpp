#include "apps/experiments/false_closures.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace helicoid {

bool is_false(const SimulatedRun& run, const Hypothesis& h) {
  const Pose2 truth = run.T_world_patch(h.a).inverse() * run.T_world_patch(h.b);
  const Pose2 apart = truth.inverse() * h.T_a_b.T_a_b;
  if (apart.distance() <= kFalseBy && std::abs(apart.yaw) <= kFalseByTurn) return false;
  // In a's frame, as the covariance.
  const Vector3d off(h.T_a_b.T_a_b.x - truth.x, h.T_a_b.T_a_b.y - truth.y, apart.yaw);
  return off.dot(h.T_a_b.covariance.ldlt().solve(off)) > kFalseByChi2;
}

}  // namespace helicoid
