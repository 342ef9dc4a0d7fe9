#include "helicoid/fit/confident_pairs.hpp"

#include <map>

#include "helicoid/fit/half_solves.hpp"

namespace helicoid {

namespace {

/// Poses this near to a hub are told by it, metres. Sets what an answer costs, not what it is.
constexpr double kHubReach = 2;

/// The interval of b's content relative to a's at a point that is `from_b` from b's origin, in a's frame.
ConfidenceInterval interval_at(const Matrix3d& covariance, const Vector2d& from_b) {
  const Vector2d lever(-from_b.y(), from_b.x());
  const Vector2d by_turn = covariance.topRightCorner<2, 1>() + 0.5 * covariance(2, 2) * lever;
  Matrix3d moved = covariance;
  moved.topLeftCorner<2, 2>() += by_turn * lever.transpose() + lever * by_turn.transpose();
  return confidence_interval(moved);
}

/// Most pairs are told without an exact answer of their own: the displacement of b's content relative to a's is the sum
/// of those along a - hub - hub - b, so that its interval is no larger than the sum of theirs, however they correlate.
class PairJudge {
 public:
  PairJudge(std::span<const Pose2> T_plane, const RelativeCovariance& covariance, std::span<const PosePair> pairs)
      : T_plane_(T_plane), halves_(covariance.system()) {
    choose_hubs(pairs);
  }

  bool is_confident(const PosePair& pair, const PairLimits& limits) {
    const auto keeps = [&](const ConfidenceInterval& interval) {
      return interval.position < limits.position && interval.heading < limits.heading;
    };
    return keeps(bound(pair)) || keeps(midway_interval(exact(pair.a, pair.b)));
  }

 private:
  struct Hub {
    std::uint32_t hub = 0;
    Matrix3d covariance = Matrix3d::Zero();  ///< of T_pose_hub
  };

  UncertainPose2 exact(std::uint32_t a, std::uint32_t b) {
    const Pose2 T_a_b = T_plane_[a].inverse() * T_plane_[b];
    return {T_a_b, halves_.relative_covariance(T_a_b, a, b)};
  }

  /// Every pose is told by the nearest hub before it; one that has none near becomes a hub.
  void choose_hubs(std::span<const PosePair> pairs) {
    std::vector<double> distance(T_plane_.size(), kHubReach);
    hubs_.resize(T_plane_.size());
    for (std::uint32_t i = 0; i < hubs_.size(); ++i) hubs_[i].hub = i;
    for (const auto& [a, b] : pairs) {
      const double there = (T_plane_[a].translation() - T_plane_[b].translation()).norm();
      if (hubs_[a].hub != a || there >= distance[b]) continue;
      distance[b] = there;
      hubs_[b].hub = a;
    }
    for (std::uint32_t i = 0; i < hubs_.size(); ++i) {
      if (hubs_[i].hub != i) hubs_[i].covariance = exact(i, hubs_[i].hub).covariance;
    }
  }

  const Matrix3d& between_hubs(std::uint32_t g, std::uint32_t h) {
    const auto [at, is_new] = between_.try_emplace({g, h}, Matrix3d::Zero());
    if (is_new && g != h) at->second = exact(g, h).covariance;
    return at->second;
  }

  /// An upper bound of the midway interval.
  ConfidenceInterval bound(const PosePair& pair) {
    const Vector2d middle = 0.5 * (T_plane_[pair.a].translation() + T_plane_[pair.b].translation());
    const Hub& a = hubs_[pair.a];
    const Hub& b = hubs_[pair.b];
    ConfidenceInterval sum;
    const auto add = [&](std::uint32_t from, std::uint32_t to, const Matrix3d& covariance) {
      const Vector2d from_to = T_plane_[from].rotation().transpose() * (middle - T_plane_[to].translation());
      const ConfidenceInterval part = interval_at(covariance, from_to);
      sum.position += part.position;
      sum.heading += part.heading;
    };
    if (a.hub != pair.a) add(pair.a, a.hub, a.covariance);
    if (a.hub != b.hub) add(a.hub, b.hub, between_hubs(a.hub, b.hub));
    if (b.hub != pair.b) add(pair.b, b.hub, b.covariance);
    return sum;
  }

  std::span<const Pose2> T_plane_;
  HalfSolves halves_;
  std::vector<Hub> hubs_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Matrix3d> between_;  ///< of T_hub_hub
};

}  // namespace

ConfidenceInterval midway_interval(const UncertainPose2& ab) {
  return interval_at(ab.covariance, -0.5 * ab.T_a_b.translation());
}

std::vector<PosePair> confident_pairs(std::span<const Pose2> T_plane, const RelativeCovariance& covariance,
                                      std::span<const PosePair> pairs, const PairLimits& limits) {
  if (pairs.empty() || !covariance.is_determined()) return {};
  PairJudge judge(T_plane, covariance, pairs);
  std::vector<PosePair> confident;
  for (const PosePair& pair : pairs) {
    if (judge.is_confident(pair, limits)) confident.push_back(pair);
  }
  return confident;
}

}  // namespace helicoid
