#include "helicoid/fit/relative_covariance.hpp"

#include "helicoid/fit/normal_equations.hpp"

namespace helicoid {

RelativeCovariance::RelativeCovariance(std::span<const Pose2> poses, std::span<const GraphEdge> edges)
    : poses_(poses.begin(), poses.end()) {
  if (poses.size() < 2) {
    determined_ = true;
    return;
  }
  equations_ = std::make_unique<NormalEquations>(poses.size(), edges, 0);
  equations_->linearise(poses);
  determined_ = equations_->factorise(0);
}

RelativeCovariance::~RelativeCovariance() = default;

UncertainPose2 RelativeCovariance::of(std::uint32_t a, std::uint32_t b) const {
  UncertainPose2 result{poses_[a].inverse() * poses_[b], Matrix3d::Zero()};
  if (a == b) return result;
  // cov(T_a_b) = J Sigma J^T with Sigma = H^-1: the columns J^T are the right-hand sides.
  const Eigen::Matrix<double, 3, 6> J = relative_jacobian(result.T_a_b);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(equations_->unknowns(), 3);
  const std::uint32_t ends[2] = {a, b};
  for (int k = 0; k < 2; ++k) {
    if (!equations_->is_fixed(ends[k])) {
      right.block<3, 3>(equations_->offset(ends[k]), 0) = J.block<3, 3>(0, 3 * k).transpose();
    }
  }
  const Matrix3d covariance = right.transpose() * equations_->solve(right);
  result.covariance = 0.5 * (covariance + covariance.transpose());
  return result;
}

}  // namespace helicoid
