#include "helicoid/fit/fit_graph.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Derivative of (t_x, t_y, phi) of T_a_b by the twists (xi_a, xi_b) of theta <- theta exp(xi). In the body's own frame
/// and with the exponential, a turn of the whole graph is an exact step however long its levers are.
Eigen::Matrix<double, 3, 6> relative_jacobian(const Pose2& T_a_b) {
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J.block<3, 3>(0, 0) = -Matrix3d::Identity();
  J(0, 2) = T_a_b.y;
  J(1, 2) = -T_a_b.x;
  J.block<2, 2>(0, 3) = T_a_b.rotation();
  J(2, 5) = 1;
  return J;
}

/// The unknowns in order: every pose but the gauge has a 3-block.
class System {
 public:
  System(std::size_t poses, std::span<const GraphEdge> edges, std::uint32_t fixed) : edges_(edges), fixed_(fixed) {
    const auto unknowns = static_cast<Eigen::Index>(3 * (poses - 1));
    hessian_.resize(unknowns, unknowns);
    gradient_.resize(unknowns);
  }

  double cost(std::span<const Pose2> poses) const {
    double sum = 0;
    for (const GraphEdge& e : edges_) sum += e.scale * e.form->cost(poses[e.a].inverse() * poses[e.b]);
    return sum;
  }

  /// Eq. 8's gradient and the expected information of eq. 9 (lower triangle).
  void linearise(std::span<const Pose2> poses) {
    triplets_.clear();
    gradient_.setZero();
    for (const GraphEdge& e : edges_) {
      const Pose2 T_a_b = poses[e.a].inverse() * poses[e.b];
      const PairExpansion pair = expand(*e.form, T_a_b);
      const Eigen::Matrix<double, 3, 6> J = relative_jacobian(T_a_b);
      const Matrix6d H = e.scale * J.transpose() * pair.information * J;
      const Vector6d g = e.scale * J.transpose() * pair.gradient;
      add_blocks(e, H, g);
    }
    hessian_.setFromTriplets(triplets_.begin(), triplets_.end());
  }

  /// The step for this damping; empty if the matrix is not positive definite.
  Eigen::VectorXd solve(double damping) {
    Sparse damped = hessian_;
    for (Eigen::Index i = 0; i < damped.rows(); ++i) damped.coeffRef(i, i) *= 1 + damping;
    if (!analysed_) solver_.analyzePattern(damped);
    analysed_ = true;
    solver_.factorize(damped);
    if (solver_.info() != Eigen::Success) return {};
    return -solver_.solve(gradient_);
  }

  Eigen::Index offset(std::uint32_t pose) const { return 3 * static_cast<Eigen::Index>(pose - (pose > fixed_ ? 1 : 0)); }
  double gradient_norm() const { return gradient_.norm(); }

  std::vector<Pose2> moved(std::span<const Pose2> poses, const Eigen::VectorXd& step) const {
    std::vector<Pose2> result(poses.begin(), poses.end());
    for (std::uint32_t i = 0; i < result.size(); ++i) {
      if (i != fixed_) result[i] = result[i] * exponential(step.segment<3>(offset(i)));
    }
    return result;
  }

 private:
  void add_blocks(const GraphEdge& e, const Matrix6d& H, const Vector6d& g) {
    const std::uint32_t ends[2] = {e.a, e.b};
    for (int k = 0; k < 2; ++k) {
      if (ends[k] == fixed_) continue;
      const Eigen::Index row = offset(ends[k]);
      gradient_.segment<3>(row) += g.segment<3>(3 * k);
      for (int l = 0; l < 2; ++l) {
        if (ends[l] == fixed_) continue;
        const Eigen::Index column = offset(ends[l]);
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) {
            if (row + i >= column + j) triplets_.emplace_back(row + i, column + j, H(3 * k + i, 3 * l + j));
          }
        }
      }
    }
  }

  std::span<const GraphEdge> edges_;
  std::uint32_t fixed_;
  Sparse hessian_;
  Eigen::VectorXd gradient_;
  std::vector<Eigen::Triplet<double>> triplets_;
  Eigen::SimplicialLDLT<Sparse, Eigen::Lower> solver_;
  bool analysed_ = false;
};

}  // namespace

FitResult fit_graph(std::span<const Pose2> start, std::span<const GraphEdge> edges, std::uint32_t fixed,
                    const FitOptions& options) {
  FitResult result;
  result.poses.assign(start.begin(), start.end());
  if (start.size() < 2 || edges.empty()) return result;
  System system(start.size(), edges, fixed);
  result.initial_cost = result.final_cost = system.cost(result.poses);
  result.status = FitStatus::iteration_limit;
  double damping = 0;
  while (result.iterations < options.max_iterations) {
    ++result.iterations;
    system.linearise(result.poses);
    result.gradient_norm = system.gradient_norm();
    bool lowered = false;
    for (int attempt = 0; attempt < 10 && !lowered; ++attempt) {
      const Eigen::VectorXd step = system.solve(damping);
      if (step.size() == 0) {
        damping = std::max(1e-6, 10 * damping);
        continue;
      }
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
