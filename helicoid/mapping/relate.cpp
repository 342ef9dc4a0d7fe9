#include "helicoid/mapping/relate.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "helicoid/manifold/seen_free.hpp"

namespace helicoid {

namespace {

/// What two poses of the same frame are apart.
Vector3d difference(const Pose2& T, const Pose2& from) {
  return {T.x - from.x, T.y - from.y, wrap_angle(T.yaw - from.yaw)};
}

/// Correspondences speak of where they were found and hold within their gate: along a bare corridor a few of them,
/// which say next to nothing, would else carry the patch off by metres at once. Metres and radians, per round.
const Matrix3d kHolds = Vector3d::Constant(1 / (0.15 * 0.15)).asDiagonal();

/// Eq. 13: the pose of the new patch that fits all its relations to patches that stay where they are; the matches were
/// made at `matched_at`.
Pose2 fit_alone(std::span<const LocalPatch> views, std::span<const PairMatch> matches, const Pose2& matched_at,
                const PosePrior& prior, double kappa) {
  Pose2 T = matched_at;
  for (int iteration = 0; iteration < 3; ++iteration) {
    Matrix3d H = prior.information + kHolds;
    Vector3d g = prior.information * difference(T, prior.T_reference_scan) + kHolds * difference(T, matched_at);
    for (std::size_t i = 0; i < views.size(); ++i) {
      const Pose2 T_a_b = views[i].T_anchor_patch.inverse() * T;
      const PairExpansion e = expand(matches[i].form, T_a_b);
      Matrix3d J = Matrix3d::Identity();
      J.topLeftCorner<2, 2>() = views[i].T_anchor_patch.rotation().transpose();
      H += J.transpose() * e.information * J / kappa;
      g += J.transpose() * e.gradient / kappa;
    }
    const Vector3d step = -(H + 1e-9 * H.trace() * Matrix3d::Identity()).ldlt().solve(g);
    T = Pose2::from_vector(T.vector() + step);
    if (step.norm() < 1e-6) break;
  }
  return T;
}

/// True if the two views say the same of most places that both speak of, b standing at T_a_b.
bool agree(const Patch& a, const Patch& b, const Pose2& T_a_b, const PairMatch& match, const RelateOptions& options) {
  const int against = count_contradictions(a, b, T_a_b, options.deep);
  return match.correspondences >= options.least_agreeing * (match.correspondences + against);
}

/// Takes out the matches of views that the patch contradicts. True if there was one.
bool drop_contradicted(const Map& map, std::span<const LocalPatch> views, const Patch& patch,
                       const Pose2& T_anchor_patch, const RelateOptions& options, std::vector<PairMatch>& matches) {
  bool dropped = false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (matches[i].correspondences == 0) continue;
    const Pose2 T_a_b = views[i].T_anchor_patch.inverse() * T_anchor_patch;
    if (agree(map.patch(views[i].patch), patch, T_a_b, matches[i], options)) continue;
    matches[i] = {};
    dropped = true;
  }
  return dropped;
}

Relation as_relation(PatchId a, PatchId b, RelationKind kind, const PairMatch& match, const Pose2& T_a_b) {
  return {a, b, kind, match.form, T_a_b, 2 * minimise(match.form, T_a_b).cost, kMatchRadius, match.correspondences};
}

}  // namespace

PairMatch match_patches(const Patch& a, const Patch& b, const Pose2& T_a_b) {
  MatchPairOptions options;
  options.incidence_bias = b.laser.incidence_bias;
  return match_pair({&a.points, &a.laser, a.scan.T_robot_laser}, b.points, T_a_b, options);
}

std::optional<Relation> match_anew(const Map& map, const Relation& relation, const Pose2& T_a_b,
                                   const RelateOptions& options) {
  const Patch& a = map.patch(relation.a);
  const Patch& b = map.patch(relation.b);
  const PairMatch match = match_patches(a, b, T_a_b);
  if (match.correspondences < options.min_correspondences || !agree(a, b, T_a_b, match, options)) return std::nullopt;
  return as_relation(relation.a, relation.b, relation.kind, match, T_a_b);
}

RelatedPatch relate(const Map& map, std::span<const LocalPatch> views, const Patch& patch, const PosePrior& prior,
                    const RelateOptions& options) {
  RelatedPatch result{prior.T_reference_scan, {}};
  std::vector<PairMatch> matches(views.size());
  Pose2 matched_at = result.T_anchor_patch;
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      matches[i] =
          match_patches(map.patch(views[i].patch), patch, views[i].T_anchor_patch.inverse() * result.T_anchor_patch);
      if (matches[i].correspondences < options.min_correspondences) matches[i] = {};
    }
    matched_at = result.T_anchor_patch;
    result.T_anchor_patch = fit_alone(views, matches, matched_at, prior, patch.laser.kappa);
    // Correspondences found this near the fitted pose would be found again.
    const Pose2 moved = matched_at.inverse() * result.T_anchor_patch;
    if (moved.distance() < options.settled_position && std::abs(moved.yaw) < options.settled_heading) break;
  }
  if (drop_contradicted(map, views, patch, result.T_anchor_patch, options, matches)) {
    result.T_anchor_patch = fit_alone(views, matches, matched_at, prior, patch.laser.kappa);
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (matches[i].correspondences == 0) continue;
    const Pose2 T_a_b = views[i].T_anchor_patch.inverse() * result.T_anchor_patch;
    result.relations.push_back(as_relation(views[i].patch, patch.id, RelationKind::overlap, matches[i], T_a_b));
  }
  return result;
}

}  // namespace helicoid
