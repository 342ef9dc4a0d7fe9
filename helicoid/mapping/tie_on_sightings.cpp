#include "helicoid/mapping/tie_on_sightings.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/close_loops.hpp"
#include "helicoid/mapping/sighting_fit.hpp"

namespace helicoid {

namespace {

/// Ties wait for one fit until there is one to so many patches: what a fit costs grows with the map.
constexpr double kWaiting = 0.01;

/// Of two patches as the graph knows them, an upper bound; nothing if it is within the limits or open.
std::optional<UncertainPose2> vague_pose(const MapInProgress& progress, PatchId a, PatchId b,
                                         const MapperOptions& options) {
  const Patch& patch = progress.map.patch(a);
  const auto is_b = [&](const BoundedPose& p) { return p.pose == b.value; };
  BoundOptions confident =
      bound_options(patch, options.reference_position, options.reference_heading, options.local_radius);
  confident.most = progress.map.patch_count();
  const std::uint32_t sought[] = {b.value};
  confident.sought = sought;
  const std::vector<BoundedPose> known = tree_bound(progress.graph, progress.map.poses(), a.value, confident);
  if (std::any_of(known.begin(), known.end(), is_b)) return std::nullopt;
  BoundOptions everything = bound_options(patch, 1e3, 1e3, 1e9);
  everything.most = progress.map.patch_count();
  everything.sought = sought;
  const std::vector<BoundedPose> all = tree_bound(progress.graph, progress.map.poses(), a.value, everything);
  const auto found = std::find_if(all.begin(), all.end(), is_b);
  if (found == all.end()) return std::nullopt;
  return found->relative;
}

/// The relative pose of the two robots' patches as the sighting has it, the doubt about either robot's place included.
UncertainPose2 between_patches(const SightingRecord& record, const UncertainPose2& T_observer_observed) {
  const PlacedRobot& p = record.observer_at;
  const PlacedRobot& q = record.candidates.front().at;
  return compound(compound({p.pose.T_patch_robot, p.covariance}, T_observer_observed),
                  invert({q.pose.T_patch_robot, q.covariance}));
}

/// The relation that a sighting amounts to; nothing if it says nothing new or does not agree.
std::optional<Relation> relation_of(const MapInProgress& progress, const LoopCloser& closer,
                                    const SightingRecord& record, const MapperOptions& options) {
  const Map& map = progress.map;
  const Hypothesis& h = closer.ledger()[record.entry];
  const bool ordered = h.state == HypothesisState::accepted && h.decided_by == DecidedBy::operator_;
  if ((!h.is_undecided() && !ordered) || record.candidates.size() != 1 || !is_usable(record.sighting)) {
    return std::nullopt;
  }
  const SeenCandidate& of = record.candidates.front();
  const PatchId p = record.observer_at.pose.patch;
  const PatchId q = of.at.pose.patch;
  const std::optional<UncertainPose2> seen = whole_pose(record.sighting);
  if (map.island_of(p) != map.island_of(q) || p == q || !seen) return std::nullopt;
  const UncertainPose2 stated = between_patches(record, *seen);
  if (!ordered) {
    const std::optional<UncertainPose2> known = vague_pose(progress, p, q, options);
    if (!known) return std::nullopt;
    const UncertainPose2 T_observer_observed =
        compound(compound(invert({record.observer_at.pose.T_patch_robot, record.observer_at.covariance}), *known),
                 {of.at.pose.T_patch_robot, of.at.covariance});
    if (!fit_of(record.sighting, T_observer_observed).agrees()) return std::nullopt;
    const SharedGround ground = compare_ground(map, progress.graph, {record.observer_at.pose, of.observers_side},
                                               {of.at.pose, of.observed_side}, *seen);
    if (ground.verdict == Verdict::contradicted) return std::nullopt;
  }
  const UncertainPose2 T_a_b = p < q ? stated : invert(stated);
  return Relation{std::min(p, q),
                  std::max(p, q),
                  RelationKind::sighting,
                  pose_pose_form(T_a_b.T_a_b, T_a_b.covariance.inverse()),
                  T_a_b.T_a_b,
                  0,
                  0,
                  0};
}

/// The map is off by more than what it calls near (eq. 12), and the sighting's noise does not account for it.
bool is_far_off(const Map& map, const Relation& said, const MapperOptions& options) {
  const Pose2 T_said_map = said.T_a_b.inverse() * map.T_plane_patch(said.a).inverse() * map.T_plane_patch(said.b);
  const Matrix3d covariance = expand(said.form, said.T_a_b).information.inverse();
  const ConfidenceInterval noise = confidence_interval(covariance);
  return T_said_map.distance() > std::max(options.reference_position, noise.position) ||
         std::abs(T_said_map.yaw) > std::max(options.reference_heading, noise.heading);
}

void accept(LoopCloser& closer, const SightingRecord& record) {
  Hypothesis h = closer.ledger()[record.entry];
  if (h.state == HypothesisState::accepted) return;
  h = entry_of(record, record.candidates.front());
  h.state = HypothesisState::accepted;
  h.decided_by = DecidedBy::sighting;
  h.reason = "agrees with the map and tells better than it how the two robots lie";
  closer.revise(record.entry, std::move(h));
}

}  // namespace

bool SightingTies::tie(MapInProgress& progress, LoopCloser& closer, const SightingLog& log, bool last,
                       const MapperOptions& options) {
  for (const SightingRecord& record : log.placed().subspan(seen_)) {
    const std::optional<Relation> relation = relation_of(progress, closer, record, options);
    if (!relation) continue;
    fit_now_ = fit_now_ || is_far_off(progress.map, *relation, options);
    progress.add(*relation);
    accept(closer, record);
    tied_.push_back(relation->a);
    tied_.push_back(relation->b);
  }
  seen_ = log.placed().size();
  const bool many = static_cast<double>(tied_.size()) > 2 * kWaiting * static_cast<double>(progress.map.patch_count());
  if (tied_.empty() || !(last || fit_now_ || many)) return false;
  spread(progress, closer, std::exchange(tied_, {}), options);
  fit_now_ = false;
  return true;
}

}  // namespace helicoid
