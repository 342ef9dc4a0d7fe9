#include "helicoid/fit/fit_graph.hpp"

#include <algorithm>

#include "helicoid/fit/normal_equations.hpp"

namespace helicoid {

FitResult fit_graph(std::span<const Pose2> start, std::span<const GraphEdge> edges, std::uint32_t fixed,
                    const FitOptions& options) {
  FitResult result;
  result.poses.assign(start.begin(), start.end());
  if (start.size() < 2 || edges.empty()) return result;
  NormalEquations system(start.size(), edges, fixed);
  result.initial_cost = result.final_cost = system.cost(result.poses);
  result.status = FitStatus::iteration_limit;
  double damping = 0;
  while (result.iterations < options.max_iterations) {
    ++result.iterations;
    system.linearise(result.poses);
    result.gradient_norm = system.gradient().norm();
    bool lowered = false;
    for (int attempt = 0; attempt < 10 && !lowered; ++attempt) {
      if (!system.factorise(damping)) {
        damping = std::max(1e-6, 10 * damping);
        continue;
      }
      const Eigen::VectorXd step = -system.solve(system.gradient());
      std::vector<Pose2> next = system.moved(result.poses, step);
      const double cost = system.cost(next);
      if (cost > result.final_cost * (1 + 1e-12)) {
        damping = std::max(1e-6, 10 * damping);
        continue;
      }
      lowered = true;
      damping = damping > 1e-6 ? 0.1 * damping : 0;
      const bool done = result.final_cost - cost <= options.relative_tolerance * result.final_cost ||
                        step.lpNorm<Eigen::Infinity>() < options.step_tolerance;
      result.poses = std::move(next);
      result.final_cost = cost;
      if (done) result.status = FitStatus::converged;
    }
    if (!lowered) result.status = damping > 1 ? FitStatus::not_positive_definite : FitStatus::converged;
    if (!lowered || result.status == FitStatus::converged) break;
  }
  return result;
}

}  // namespace helicoid
