#include "apps/experiments/false_closures.hpp"

#include <cmath>

#include "helicoid/manifold/stated_confidence.hpp"

namespace helicoid {

bool is_false(const SimulatedRun& run, const Hypothesis& h) {
  const Pose2 truth = run.T_world_patch(h.a).inverse() * run.T_world_patch(h.b);
  const Pose2 apart = truth.inverse() * h.T_a_b.T_a_b;
  if (apart.distance() <= kFalseBy && std::abs(apart.yaw) <= kFalseByTurn) return false;
  return is_beyond_said(h.T_a_b, truth);
}

}  // namespace helicoid
