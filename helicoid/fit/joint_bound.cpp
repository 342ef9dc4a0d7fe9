#include "helicoid/fit/joint_bound.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace helicoid {

namespace {

/// One radian of heading counts as much as this many metres when near poses are chosen.
constexpr double kMetresPerRadian = 1;

bool is_confident(const BoundedPose& pose, const BoundOptions& options) {
  const ConfidenceInterval interval = confidence_interval(pose.relative.covariance);
  return interval.position < options.position && interval.heading < options.heading;
}

/// The candidates nearest to the reference (candidates[0]) that relations among themselves tie to it, as places in
/// `candidates`; the reference is left out.
std::vector<std::size_t> choose_tied(const InformationGraph& graph, std::span<const BoundedPose> candidates,
                                     std::size_t most) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const Pose2& T = candidates[i].relative.T_a_b;
    ranked.emplace_back(T.distance() + kMetresPerRadian * std::abs(T.yaw), i);
  }
  std::sort(ranked.begin(), ranked.end());
  ranked.resize(std::min(most, ranked.size()));
  std::vector<std::int32_t> place(graph.size(), -1);
  for (const auto& [distance, i] : ranked) place[candidates[i].pose] = static_cast<std::int32_t>(i);
  std::vector<std::size_t> tied{0};
  for (std::size_t next = 0; next < tied.size(); ++next) {
    for (const InformationGraph::Edge& edge : graph.edges(candidates[tied[next]].pose)) {
      if (place[edge.to] < 0) continue;
      tied.push_back(static_cast<std::size_t>(place[edge.to]));
      place[edge.to] = -1;
    }
  }
  tied.erase(tied.begin());
  return tied;
}

/// The lower triangle of the information of (x, y, yaw) of the tied poses in the reference's frame (eq. 9), the
/// reference held.
Eigen::MatrixXd joint_information(const InformationGraph& graph, std::span<const BoundedPose> candidates,
                                  std::span<const std::size_t> tied) {
  constexpr std::int32_t kAbsent = -2;
  constexpr std::int32_t kReference = -1;
  std::vector<std::int32_t> place(graph.size(), kAbsent);
  place[candidates[0].pose] = kReference;
  for (std::size_t i = 0; i < tied.size(); ++i) place[candidates[tied[i]].pose] = static_cast<std::int32_t>(i);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3 * std::ssize(tied), 3 * std::ssize(tied));
  for (std::size_t i = 0; i < tied.size(); ++i) {
    const Pose2& T_ref_b = candidates[tied[i]].relative.T_a_b;
    const auto row = 3 * static_cast<Eigen::Index>(i);
    for (const InformationGraph::Edge& edge : graph.edges(candidates[tied[i]].pose)) {
      const std::int32_t j = place[edge.to];
      // d T_b_other / d T_ref_b; each pair is seen from both of its ends, and each end adds its own block.
      if (j == kAbsent) continue;
      const Pose2 T_b_other =
          T_ref_b.inverse() *
          (j == kReference ? Pose2{} : candidates[tied[static_cast<std::size_t>(j)]].relative.T_a_b);
      Matrix3d by_other = Matrix3d::Identity();
      by_other.topLeftCorner<2, 2>() = T_ref_b.rotation().transpose();
      Matrix3d by_self = -by_other;
      by_self(0, 2) = T_b_other.y;
      by_self(1, 2) = -T_b_other.x;
      const Matrix3d weighted = by_self.transpose() * edge.information;
      H.block<3, 3>(row, row) += weighted * by_self;
      if (j >= 0 && j < static_cast<std::int32_t>(i)) H.block<3, 3>(row, 3 * j) += weighted * by_other;
    }
  }
  return H;
}

}  // namespace

std::vector<BoundedPose> joint_bound(const InformationGraph& graph, std::span<const Pose2> T_plane,
                                     std::uint32_t reference, const BoundOptions& options,
                                     const JointBoundOptions& joint) {
  BoundOptions wide = options;
  wide.position *= joint.slack;
  wide.heading *= joint.slack;
  std::vector<BoundedPose> candidates = tree_bound(graph, T_plane, reference, wide);
  const auto is_known = [&](std::size_t i) { return is_confident(candidates[i], options); };
  std::vector<std::size_t> tied = choose_tied(graph, candidates, joint.joint);
  // Those in doubt last: only the end of the factor is then needed for them.
  const auto doubtful = std::stable_partition(tied.begin(), tied.end(), is_known);
  if (doubtful != tied.end()) {
    Eigen::MatrixXd H = joint_information(graph, candidates, tied);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(H);
    const Eigen::Index size = 3 * (tied.end() - doubtful);
    if (factor.info() == Eigen::Success) {
      const Eigen::MatrixXd inverse =
          H.bottomRightCorner(size, size).triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(size, size));
      const Matrix3d floor = noise_floor(options.floor_position, options.floor_heading);
      for (auto i = doubtful; i != tied.end(); ++i) {
        UncertainPose2& relative = candidates[*i].relative;
        const auto columns = inverse.middleCols<3>(3 * (i - doubtful));
        relative.covariance = columns.transpose() * columns;
        relative.covariance = with_noise_floor(relative, floor, floor);
      }
    }
  }
  std::erase_if(candidates, [&](const BoundedPose& p) { return !is_confident(p, options); });
  return candidates;
}

}  // namespace helicoid
