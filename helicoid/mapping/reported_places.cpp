#include "helicoid/mapping/reported_places.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "helicoid/mapping/close_loops.hpp"
#include "helicoid/mapping/island_evidence.hpp"
#include "helicoid/mapping/sighting_log.hpp"

namespace helicoid {

namespace {

UncertainPose2 reported(const Lookalike& alike) {
  UncertainPose2 T_there_here{alike.T_there_robot, Matrix3d::Zero()};
  const double variance = alike.sigma_position * alike.sigma_position;
  T_there_here.covariance.diagonal() << variance, variance, alike.sigma_heading * alike.sigma_heading;
  return T_there_here;
}

/// Between the patches that the two places stand on.
Hypothesis entry_of(const ManifoldPose& there, const ManifoldPose& here, const Lookalike& alike,
                    const SharedGround& ground) {
  const UncertainPose2 T = compound(compound({there.T_patch_robot, Matrix3d::Zero()}, reported(alike)),
                                    {here.T_patch_robot.inverse(), Matrix3d::Zero()});
  Hypothesis h;
  h.a = std::min(there.patch, here.patch);
  h.b = std::max(there.patch, here.patch);
  h.T_a_b = there.patch == h.a ? T : invert(T);
  h.score = ground.share();
  h.ambiguity = 1;  // whoever reports one place does not say how much better it is than the next
  return h;
}

std::vector<std::size_t> enter(const MapInProgress& progress, LoopCloser& closer, Hypothesis h,
                               const SharedGround& ground, const MapperOptions& options) {
  if (ground.verdict == Verdict::confirmed) {
    const bool within = progress.map.island_of(h.a) == progress.map.island_of(h.b);
    return within ? closer.consider_within(progress.map, progress.graph, std::move(h))
                  : closer.consider_between(progress.map, progress.graph, std::move(h), options.join_on_evidence);
  }
  h.reason = "reported; the scans cannot tell";
  if (ground.verdict == Verdict::contradicted) {
    h.state = HypothesisState::rejected;
    h.decided_by = DecidedBy::evidence;
    h.reason = fmt::format(
        "reported, but the scans contradict it: {} points agree and {} lie deep in what another scan saw as free",
        ground.agreeing, ground.against);
  }
  closer.record(std::move(h));
  return {};
}

}  // namespace

void ReportedPlaces::add(RobotId robot, RobotId there, double stamp, const Lookalike& alike) {
  waiting_.push_back({robot, there, stamp, alike});
}

bool ReportedPlaces::take_placed(MapInProgress& progress, LoopCloser& closer, bool last, const MapperOptions& options) {
  bool changed = false;
  JoinTrials trials;
  std::erase_if(waiting_, [&](const Waiting& w) {
    const std::optional<PlacedRobot> here = place_at(progress.map, w.robot, w.stamp, last);
    const std::optional<PlacedRobot> there = place_at(progress.map, w.there, w.alike.stamp, last);
    if (!here || !there) return false;
    if (here->pose.patch == there->pose.patch) return true;
    const SharedGround ground =
        compare_ground(progress.map, progress.graph, {there->pose, {}}, {here->pose, {}}, reported(w.alike));
    const std::vector<std::size_t> accepted =
        enter(progress, closer, entry_of(there->pose, here->pose, w.alike, ground), ground, options);
    if (accepted.empty()) return true;
    changed = act_on_or_join(progress, closer, accepted, trials, options) || changed;
    return true;
  });
  return changed;
}

}  // namespace helicoid
