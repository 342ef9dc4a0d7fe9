#include "helicoid/fit/relative_covariance.hpp"

#include "helicoid/fit/linear_system.hpp"

namespace helicoid {

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
  result.covariance = system_->relative_covariance(result.T_a_b, a, b);
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
