#include "helicoid/fit/normal_equations.hpp"

namespace helicoid {

Eigen::Matrix<double, 3, 6> relative_jacobian(const Pose2& T_a_b) {
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J.block<3, 3>(0, 0) = -Matrix3d::Identity();
  J(0, 2) = T_a_b.y;
  J(1, 2) = -T_a_b.x;
  J.block<2, 2>(0, 3) = T_a_b.rotation();
  J(2, 5) = 1;
  return J;
}

NormalEquations::NormalEquations(std::size_t poses, std::span<const GraphEdge> edges, std::uint32_t fixed)
    : edges_(edges), fixed_(fixed) {
  const auto unknowns = static_cast<Eigen::Index>(3 * (poses - 1));
  hessian_.resize(unknowns, unknowns);
  gradient_.resize(unknowns);
}

double NormalEquations::cost(std::span<const Pose2> poses) const {
  double sum = 0;
  for (const GraphEdge& e : edges_) sum += e.scale * e.form->cost(poses[e.a].inverse() * poses[e.b]);
  return sum;
}

void NormalEquations::linearise(std::span<const Pose2> poses) {
  triplets_.clear();
  gradient_.setZero();
  for (const GraphEdge& e : edges_) {
    const Pose2 T_a_b = poses[e.a].inverse() * poses[e.b];
    const PairExpansion pair = expand(*e.form, T_a_b);
    const Eigen::Matrix<double, 3, 6> J = relative_jacobian(T_a_b);
    add_blocks(e, e.scale * J.transpose() * pair.information * J, e.scale * J.transpose() * pair.gradient);
  }
  hessian_.setFromTriplets(triplets_.begin(), triplets_.end());
}

void NormalEquations::add_blocks(const GraphEdge& edge, const Eigen::Matrix<double, 6, 6>& H,
                                 const Eigen::Matrix<double, 6, 1>& g) {
  const std::uint32_t ends[2] = {edge.a, edge.b};
  for (int k = 0; k < 2; ++k) {
    if (is_fixed(ends[k])) continue;
    const Eigen::Index row = offset(ends[k]);
    gradient_.segment<3>(row) += g.segment<3>(3 * k);
    for (int l = 0; l < 2; ++l) {
      if (is_fixed(ends[l])) continue;
      const Eigen::Index column = offset(ends[l]);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          if (row + i >= column + j) triplets_.emplace_back(row + i, column + j, H(3 * k + i, 3 * l + j));
        }
      }
    }
  }
}

bool NormalEquations::factorise(double damping) {
  Sparse damped = hessian_;
  for (Eigen::Index i = 0; i < damped.rows(); ++i) damped.coeffRef(i, i) *= 1 + damping;
  if (!analysed_) solver_.analyzePattern(damped);
  analysed_ = true;
  solver_.factorize(damped);
  return solver_.info() == Eigen::Success;
}

std::vector<Pose2> NormalEquations::moved(std::span<const Pose2> poses, const Eigen::VectorXd& step) const {
  std::vector<Pose2> result(poses.begin(), poses.end());
  for (std::uint32_t i = 0; i < result.size(); ++i) {
    if (!is_fixed(i)) result[i] = result[i] * exponential(step.segment<3>(offset(i)));
  }
  return result;
}

}  // namespace helicoid
