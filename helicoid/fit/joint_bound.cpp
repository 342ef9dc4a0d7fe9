#include "helicoid/fit/joint_bound.hpp"

#include <algorithm>
#include <memory>

#include "helicoid/fit/front_kernels.hpp"
#include "helicoid/fit/pose_marks.hpp"

namespace helicoid {

namespace {

bool is_confident(const BoundedPose& pose, const BoundOptions& options) {
  const ConfidenceInterval interval = confidence_interval(pose.relative.covariance);
  return interval.position < options.position && interval.heading < options.heading;
}

/// The candidates nearest to the reference (candidates[0]) that relations among themselves tie to it, as places in
/// `candidates`; the reference is left out.
std::vector<std::size_t> choose_tied(const InformationGraph& graph, std::span<const BoundedPose> candidates,
                                     std::size_t most) {
  constexpr std::int32_t kTaken = -2;
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    ranked.emplace_back(nearness(candidates[i].relative.T_a_b), i);
  }
  std::sort(ranked.begin(), ranked.end());
  ranked.resize(std::min(most, ranked.size()));
  PoseMarks place(graph.size());
  for (const auto& [distance, i] : ranked) place.set(candidates[i].pose, static_cast<std::int32_t>(i));
  std::vector<std::size_t> tied{0};
  for (std::size_t next = 0; next < tied.size(); ++next) {
    for (const InformationGraph::Edge& edge : graph.edges(candidates[tied[next]].pose)) {
      if (place[edge.to] < 0) continue;
      tied.push_back(static_cast<std::size_t>(place[edge.to]));
      place.set(edge.to, kTaken);
    }
  }
  tied.erase(tied.begin());
  return tied;
}

/// The lower triangle of the information of (x, y, yaw) of the tied poses in the reference's frame (eq. 9), the
/// reference held, as a front: the poses that are known already are its pivots, those in doubt what lies below.
class JointInformation {
 public:
  JointInformation(std::size_t known, std::size_t doubtful)
      : shape_{3 * static_cast<int>(known), 3 * static_cast<int>(doubtful)},
        panel_(shape_.panel_size(), 0.0),
        update_(shape_.update_size(), 0.0) {}

  void add(std::size_t row, std::size_t column, const Matrix3d& block) {
    const auto top = 3 * static_cast<int>(row);
    const auto left = 3 * static_cast<int>(column);
    const bool is_pivot = left < shape_.pivots;
    const int gap = top < shape_.pivots ? 0 : shape_.first_below() - shape_.pivots;
    const int height = is_pivot ? shape_.leading() : padded(shape_.below);
    const int first = is_pivot ? left : left - shape_.pivots;
    double* corner = is_pivot ? panel_.data() + shape_.panel_column(first) + top + gap
                              : update_.data() + shape_.update_column(first) + top - shape_.pivots;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) corner[c * between_columns(height, first) + r] += block(r, c);
    }
  }

  /// The covariance of all poses in doubt (column-major, padded(3 n) x 3 n); empty if the information is singular.
  std::vector<double> invert_doubtful() {
    const FrontKernels& kernels = front_kernels();
    const FrontShape doubtful{shape_.below, 0};
    const auto workspace =
        std::make_unique_for_overwrite<double[]>(std::max(shape_.workspace_size(), doubtful.workspace_size()));
    if (shape_.pivots > 0 && !kernels.eliminate(shape_, panel_.data(), update_.data(), workspace.get())) return {};
    double none = 0;
    if (!kernels.eliminate(doubtful, update_.data(), &none, workspace.get())) return {};
    std::vector<double> inverse(static_cast<std::size_t>(doubtful.leading()) * doubtful.leading(), 0.0);
    kernels.invert(doubtful, update_.data(), inverse.data(), workspace.get());
    return inverse;
  }

 private:
  FrontShape shape_;
  std::vector<double> panel_, update_;
};

JointInformation joint_information(const InformationGraph& graph, std::span<const BoundedPose> candidates,
                                   std::span<const std::size_t> tied, std::size_t known) {
  constexpr std::int32_t kReference = -2;
  PoseMarks place(graph.size());
  place.set(candidates[0].pose, kReference);
  for (std::size_t i = 0; i < tied.size(); ++i) place.set(candidates[tied[i]].pose, static_cast<std::int32_t>(i));
  JointInformation H(known, tied.size() - known);
  for (std::size_t i = 0; i < tied.size(); ++i) {
    const Pose2 T_b_ref = candidates[tied[i]].relative.T_a_b.inverse();
    const Matrix2d R_b_ref = T_b_ref.rotation();
    Matrix3d by_other = Matrix3d::Identity();
    by_other.topLeftCorner<2, 2>() = R_b_ref;
    for (const InformationGraph::Edge& edge : graph.edges(candidates[tied[i]].pose)) {
      const std::int32_t j = place[edge.to];
      // d T_b_other / d T_ref_b; each pair is seen from both of its ends, and each end adds its own block.
      if (j == PoseMarks::kNone) continue;
      Vector2d p_b_other = T_b_ref.translation();
      if (j >= 0) p_b_other += R_b_ref * candidates[tied[static_cast<std::size_t>(j)]].relative.T_a_b.translation();
      Matrix3d by_self = -by_other;
      by_self(0, 2) = p_b_other.y();
      by_self(1, 2) = -p_b_other.x();
      const Matrix3d weighted = by_self.transpose() * edge.information;
      H.add(i, i, weighted * by_self);
      if (j >= 0 && j < static_cast<std::int32_t>(i)) H.add(i, static_cast<std::size_t>(j), weighted * by_other);
    }
  }
  return H;
}

}  // namespace

std::vector<BoundedPose> joint_bound(const InformationGraph& graph, std::span<const Pose2> T_plane,
                                     std::uint32_t reference, const BoundOptions& options,
                                     const JointBoundOptions& joint) {
  BoundOptions wide = options;
  wide.slack = joint.slack;
  wide.nearest = joint.joint;
  std::vector<BoundedPose> candidates = tree_bound(graph, T_plane, reference, wide);
  const auto is_known = [&](std::size_t i) { return is_confident(candidates[i], options); };
  std::vector<std::size_t> tied = choose_tied(graph, candidates, joint.joint);
  // Those in doubt last: only the end of the factor is then needed for them.
  const auto doubtful = std::stable_partition(tied.begin(), tied.end(), is_known);
  if (doubtful != tied.end()) {
    const auto known = static_cast<std::size_t>(doubtful - tied.begin());
    const std::vector<double> covariance = joint_information(graph, candidates, tied, known).invert_doubtful();
    const Eigen::Index leading = padded(3 * static_cast<int>(tied.size() - known));
    const Matrix3d floor = noise_floor(options.floor_position, options.floor_heading);
    for (std::size_t i = known; i < tied.size() && !covariance.empty(); ++i) {
      UncertainPose2& relative = candidates[tied[i]].relative;
      const auto corner = 3 * static_cast<Eigen::Index>(i - known);
      relative.covariance = Eigen::Map<const Matrix3d, 0, Eigen::OuterStride<>>(
          covariance.data() + corner * (leading + 1), Eigen::OuterStride<>(leading));
      relative.covariance = with_noise_floor(relative, floor, floor);
    }
  }
  std::erase_if(candidates, [&](const BoundedPose& p) { return !is_confident(p, options); });
  return candidates;
}

}  // namespace helicoid
