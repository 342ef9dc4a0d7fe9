#include "helicoid/fit/innovation.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "helicoid/fit/linear_system.hpp"

namespace helicoid {

FittedPart::FittedPart(const RelationGraph& graph, const std::vector<bool>& taken, std::span<const Pose2> start,
                       std::span<const std::uint32_t> fixed, const FitOptions& options) {
  part_.poses.assign(start.begin(), start.end());
  part_.is_landmark = graph.is_landmark;
  for (std::size_t i = 0; i < graph.relations.size(); ++i) {
    if (taken[i]) part_.relations.push_back(graph.relations[i]);
  }
  FitOptions plain = options;
  plain.loss = {};
  FitResult fitted = fit(part_, fixed, plain);
  part_.poses = std::move(fitted.poses);
  cost_ = fitted.final_cost;
  constexpr std::int64_t kEnough = 30;
  const std::int64_t degrees = degrees_of_freedom(part_);
  if (degrees >= kEnough) {
    variance_factor_ = std::max(0.0, 2 * (cost_ - least_cost(part_))) / static_cast<double>(degrees);
  }
  system_ = std::make_unique<LinearSystem>(part_, fixed);
  system_->linearise(part_.poses);
  if (!system_->factorise()) system_.reset();
}

FittedPart::~FittedPart() = default;

Innovation FittedPart::innovation(const GraphRelation& relation, bool is_taken) const {
  const Pose2& T_plane_b = part_.poses[relation.b];
  const Pose2 T_a_b = relation.a == kWorld ? T_plane_b : part_.poses[relation.a].inverse() * T_plane_b;
  PairExpansion own = expand(relation.measurement, RelativePose::of(T_a_b));
  if (const auto* m = std::get_if<Correspondences>(&relation.measurement)) own.cost -= m->scale * m->least_cost;
  const Matrix3d P = system_->relative_covariance(T_a_b, relation.a, relation.b);
  // Own information Q Q^T, own gradient Q u: of a pose-pose relation with residual e, u^T u = e^T R^-1 e, and
  // e^T (R +- P)^-1 e is u^T (1 +- Q^T P Q)^-1 u. So nothing large is taken from something as large.
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(own.information);
  const Vector3d root = axes.eigenvalues().cwiseMax(1e-15 * axes.eigenvalues().maxCoeff()).cwiseMax(1e-200).cwiseSqrt();
  const Matrix3d Q = axes.eigenvectors() * root.asDiagonal();
  const Vector3d u = root.cwiseInverse().asDiagonal() * axes.eigenvectors().transpose() * own.gradient;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> shared(Q.transpose() * P * Q);
  const Vector3d along = shared.eigenvectors().transpose() * u;
  Innovation result;
  // What no pose could explain.
  result.chi2 = std::max(0.0, 2 * own.cost - u.squaredNorm());
  for (int k = 0; k < 3; ++k) {
    // Nothing else holds this direction: no contradiction, and rounding is all that is left of it.
    constexpr double kAlone = 1e-9;
    const double share = shared.eigenvalues()[k];
    if (is_taken && share > 1 - kAlone) continue;
    const double ratio = is_taken ? 1 - share : 1 + share;
    result.chi2 += along[k] * along[k] / ratio;
    result.log_volume += std::log(ratio) - 2 * std::log(root[k]);
  }
  return result;
}

}  // namespace helicoid
