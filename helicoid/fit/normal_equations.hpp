// The normal equations of a graph of relations (eq. 8 linearised): gradient and expected information (eq. 9), sparse.
// Unknowns are twists xi in each pose's own frame, theta <- theta exp(xi): with the exponential, a turn of the whole
// graph is an exact step however long its levers are.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "helicoid/fit/fit_graph.hpp"

namespace helicoid {

/// Derivative of (t_x, t_y, phi) of T_a_b by the twists (xi_a, xi_b); 3 x 6.
[[nodiscard]] Eigen::Matrix<double, 3, 6> relative_jacobian(const Pose2& T_a_b);

/// Every pose but the gauge has a block of three unknowns.
class NormalEquations {
 public:
  NormalEquations(std::size_t poses, std::span<const GraphEdge> edges, std::uint32_t fixed);

  [[nodiscard]] double cost(std::span<const Pose2> poses) const;
  void linearise(std::span<const Pose2> poses);
  /// Factorises the information with this relative damping of its diagonal; false if it is not positive definite.
  bool factorise(double damping);
  /// H x = right-hand side, with the last factor.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const { return solver_.solve(right); }

  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }
  [[nodiscard]] Eigen::Index unknowns() const { return gradient_.size(); }
  [[nodiscard]] bool is_fixed(std::uint32_t pose) const { return pose == fixed_; }
  /// The first of a pose's three unknowns; the pose is not the gauge.
  [[nodiscard]] Eigen::Index offset(std::uint32_t pose) const {
    return 3 * static_cast<Eigen::Index>(pose - (pose > fixed_ ? 1 : 0));
  }
  [[nodiscard]] std::vector<Pose2> moved(std::span<const Pose2> poses, const Eigen::VectorXd& step) const;

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  void add_blocks(const GraphEdge& edge, const Eigen::Matrix<double, 6, 6>& H, const Eigen::Matrix<double, 6, 1>& g);

  std::span<const GraphEdge> edges_;
  std::uint32_t fixed_;
  Sparse hessian_;  ///< lower triangle
  Eigen::VectorXd gradient_;
  std::vector<Eigen::Triplet<double>> triplets_;
  Eigen::SimplicialLDLT<Sparse, Eigen::Lower> solver_;
  bool analysed_ = false;
};

}  // namespace helicoid
