#include "helicoid/fit/relative_covariance.hpp"

#include "helicoid/fit/linear_system.hpp"

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

RelativeCovariance::RelativeCovariance(std::span<const Pose2> poses, std::span<const GraphEdge> edges)
    : RelativeCovariance(make_graph(poses, edges)) {}

RelativeCovariance::RelativeCovariance(RelationGraph graph) : graph_(std::move(graph)) {
  std::erase_if(graph_.relations, [](const GraphRelation& r) { return r.a == kWorld; });
  if (graph_.poses.size() < 2) {
    determined_ = true;
    return;
  }
  system_ = std::make_unique<LinearSystem>(graph_, std::span<const std::uint32_t>());
  determined_ = factorise(0);
}

RelativeCovariance::~RelativeCovariance() = default;

bool RelativeCovariance::factorise(std::uint32_t held) {
  held_ = held;
  const std::uint32_t fixed[] = {held};
  system_->hold(fixed);
  system_->linearise(graph_.poses);
  return system_->factorise();
}

UncertainPose2 RelativeCovariance::of(std::uint32_t a, std::uint32_t b) const {
  UncertainPose2 result{graph_.poses[a].inverse() * graph_.poses[b], Matrix3d::Zero()};
  if (a == b) return result;
  // cov(T_a_b) = J Sigma J^T with Sigma = H^-1: the columns J^T are the right-hand sides.
  const Eigen::Matrix<double, 3, 6> J = relative_jacobian(result.T_a_b);
  const std::uint32_t ends[2] = {a, b};
  Eigen::Matrix<double, 6, 3> columns;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> x(kBlock * graph_.poses.size(), 0.0);
    for (int k = 0; k < 2; ++k) {
      if (ends[k] == held_) continue;
      for (int i = 0; i < 3; ++i) x[system_->offset(ends[k]) + static_cast<std::size_t>(i)] = J(c, 3 * k + i);
    }
    system_->solve(x);
    for (int k = 0; k < 2; ++k) {
      for (int i = 0; i < 3; ++i) {
        columns(3 * k + i, c) = ends[k] == held_ ? 0 : x[system_->offset(ends[k]) + static_cast<std::size_t>(i)];
      }
    }
  }
  const Matrix3d covariance = J * columns;
  result.covariance = 0.5 * (covariance + covariance.transpose());
  return result;
}

std::vector<UncertainPose2> RelativeCovariance::relative_to(std::uint32_t a) {
  std::vector<UncertainPose2> result(graph_.poses.size());
  if (!determined_ || !system_) return result;
  if (held_ != a) determined_ = factorise(a);
  const std::vector<double> blocks = system_->inverse_diagonal();
  const Pose2 T_a_plane = graph_.poses[a].inverse();
  for (std::uint32_t b = 0; b < result.size(); ++b) {
    result[b].T_a_b = T_a_plane * graph_.poses[b];
    if (b == a) continue;
    // A twist of b moves it along its own axes.
    Matrix3d turn = Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = result[b].T_a_b.rotation();
    result[b].covariance = transport(turn, Eigen::Map<const Matrix3d>(blocks.data() + 3 * system_->offset(b)));
  }
  return result;
}

}  // namespace helicoid
