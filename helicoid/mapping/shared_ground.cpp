#include "helicoid/mapping/shared_ground.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "helicoid/manifold/seen_free.hpp"

namespace helicoid {

namespace {

constexpr int kRounds = 4;
constexpr int kMinCorrespondences = 20;

struct NearPatch {
  PatchId patch;
  Pose2 T_place_patch;
};

/// The nearest patches about a place.
std::vector<NearPatch> patches_about(const Map& map, const InformationGraph& graph, const Ground& ground,
                                     const SharedGroundOptions& options) {
  std::vector<NearPatch> near;
  for (const LocalPatch& p : find_local_map(map, graph, ground.place.patch, MapperOptions{})) {
    const RobotId robot = map.patch(p.patch).robot;
    if (!ground.robots.empty() && std::count(ground.robots.begin(), ground.robots.end(), robot) == 0) continue;
    const Pose2 T_place_patch = ground.place.T_patch_robot.inverse() * p.T_anchor_patch;
    if (T_place_patch.distance() <= options.reach) near.push_back({p.patch, T_place_patch});
  }
  std::stable_sort(near.begin(), near.end(), [](const NearPatch& x, const NearPatch& y) {
    return x.T_place_patch.distance() < y.T_place_patch.distance();
  });
  near.resize(std::min(near.size(), options.patches));
  return near;
}

/// Where b fits a best about `supposed`, and how many points then correspond.
struct Fitted {
  Pose2 T_a_b;
  int correspondences = 0;
};
Fitted fit_about(const Patch& a, const Patch& b, const Pose2& supposed, const Matrix3d& prior_information) {
  Fitted fitted{supposed, 0};
  for (int round = 0; round < kRounds; ++round) {
    const PairMatch match = match_patches(a, b, fitted.T_a_b);
    fitted.correspondences = match.correspondences >= kMinCorrespondences ? match.correspondences : 0;
    if (fitted.correspondences == 0) break;
    const PairExpansion e = expand(match.form, fitted.T_a_b);
    const Pose2& T = fitted.T_a_b;
    const Vector3d off(T.x - supposed.x, T.y - supposed.y, wrap_angle(T.yaw - supposed.yaw));
    const Matrix3d H = e.information / b.laser.kappa + prior_information;
    const Vector3d g = e.gradient / b.laser.kappa + prior_information * off;
    fitted.T_a_b = Pose2::from_vector(T.vector() - H.ldlt().solve(g));
  }
  return fitted;
}

/// What the patches about two places say of each other if these lie so.
SharedGround compare_at(const Map& map, std::span<const NearPatch> about_p, std::span<const NearPatch> about_q,
                        const Pose2& T_p_q, const Matrix3d& information, const SharedGroundOptions& options) {
  SharedGround ground;
  for (const NearPatch& b : about_q) {
    for (const NearPatch& a : about_p) {
      if (a.patch == b.patch) continue;
      const Pose2 supposed = a.T_place_patch.inverse() * T_p_q * b.T_place_patch;
      if (supposed.distance() > options.most_apart) continue;
      const Fitted fitted = fit_about(map.patch(a.patch), map.patch(b.patch), supposed, information);
      ground.agreeing += fitted.correspondences;
      ground.against += count_contradictions_across(map.patch(a.patch), map.patch(b.patch), fitted.T_a_b, options.deep);
    }
  }
  if (std::abs(ground.agreeing - ground.against) >= options.least_majority) {
    ground.verdict = ground.agreeing > ground.against ? Verdict::confirmed : Verdict::contradicted;
  }
  return ground;
}

}  // namespace

SharedGround compare_ground(const Map& map, const InformationGraph& graph, const Ground& p, const Ground& q,
                            const UncertainPose2& T_p_q, const SharedGroundOptions& options) {
  const std::vector<NearPatch> about_p = patches_about(map, graph, p, options);
  const std::vector<NearPatch> about_q = patches_about(map, graph, q, options);
  // A floor, so that the surest statement may be off by what scans are off by; and what a turn moves at that reach.
  Matrix3d covariance = T_p_q.covariance;
  const double turn = std::sqrt(covariance(2, 2));
  const double swing = std::pow(options.reach * turn, 2);
  covariance.diagonal() += Vector3d(0.05 * 0.05 + swing, 0.05 * 0.05 + swing, 0.02 * 0.02);
  // What stands metres away is moved out of a match's reach by the heading's error alone: it is looked for.
  SharedGround best;
  for (const double sigmas : {0.0, 1.0, -1.0, 2.0, -2.0}) {
    const Pose2 T = T_p_q.T_a_b * Pose2{0, 0, sigmas * turn};
    const SharedGround ground = compare_at(map, about_p, about_q, T, covariance.inverse(), options);
    if (sigmas == 0 || ground.agreeing - ground.against > best.agreeing - best.against) best = ground;
    if (best.verdict == Verdict::confirmed || turn == 0) break;
  }
  return best;
}

std::vector<RobotId> robots_on(const Map& map, IslandId island) {
  std::vector<bool> is_on(map.robots().size(), false);
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const PatchId id = make_id<PatchId>(i);
    if (map.island_of(id) == island) is_on[map.patch(id).robot.index()] = true;
  }
  std::vector<RobotId> robots;
  for (std::size_t i = 0; i < is_on.size(); ++i) {
    if (is_on[i]) robots.push_back(make_id<RobotId>(i));
  }
  return robots;
}

}  // namespace helicoid
