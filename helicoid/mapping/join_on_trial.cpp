#include "helicoid/mapping/join_on_trial.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "helicoid/mapping/island_overlay.hpp"
#include "helicoid/mapping/join_islands.hpp"

namespace helicoid {

namespace {

/// Two placements nearer than this are one, metres and radians: what a search for places tells apart.
constexpr double kSamePlacement = 0.6;
constexpr double kSamePlacementTurn = 0.25;

IslandJoin join_of(const Hypothesis& h) {
  IslandJoin join;
  join.determined = true;
  join.a = h.a;
  join.b = h.b;
  join.T_a_b = h.T_a_b.T_a_b;
  join.information = h.T_a_b.covariance.inverse();
  return join;
}

std::string contradiction_in_words(const IslandOverlay& overlay) {
  return fmt::format(
      "agrees with others, but laid over one another by them the islands contradict each other: at {} of {} places "
      "that both know something stood for one that was gone for the other ({:.2f} %); within one of them that is so at "
      "{} of {} ({:.2f} %)",
      overlay.between.gone, overlay.between.places, 100 * overlay.between.share(), overlay.within.gone,
      overlay.within.places, 100 * overlay.within.share());
}

/// Makes the map what it became on trial: relations are only ever added.
void adopt(MapInProgress& progress, const Map& joined, const Hypothesis& h) {
  const IslandId into = joined.island_of(h.a);
  const IslandId from = progress.map.island_of(progress.map.island_of(h.a) == into ? h.b : h.a);
  progress.editor.merge_islands(into, from, Pose2{});
  for (std::size_t i = 0; i < joined.patch_count(); ++i) {
    progress.editor.set_pose(make_id<PatchId>(i), joined.poses()[i]);
  }
  for (const Relation& r : joined.relations().subspan(progress.map.relations().size())) progress.editor.add_relation(r);
}

/// Takes back that entries were accepted.
void leave_open(LoopCloser& closer, std::span<const std::size_t> accepted, const std::string& reason) {
  for (const std::size_t entry : accepted) {
    Hypothesis h = closer.ledger()[entry];
    h.state = HypothesisState::open;
    h.reason = reason;
    closer.revise(entry, std::move(h));
  }
}

}  // namespace

void join_by_entries(MapInProgress& progress, LoopCloser& closer, std::span<const std::size_t> accepted,
                     const MapperOptions& mapper) {
  move_rigidly(progress, join_of(closer.ledger()[accepted.back()]));
  act_on(progress, closer, accepted, mapper);
  close_loops_again(progress, closer, mapper);
}

bool JoinTrials::join_if_it_holds(MapInProgress& progress, LoopCloser& closer, std::span<const std::size_t> accepted,
                                  const MapperOptions& mapper) {
  const Hypothesis& h = closer.ledger()[accepted.back()];
  const auto known = std::find_if(refused_.begin(), refused_.end(), [&](const Refused& r) { return r.is_of(h); });
  if (known != refused_.end()) {
    leave_open(closer, accepted, known->reason);
    return false;
  }
  Map joined = progress.map;
  MapEditor editor(joined);
  InformationGraph graph = progress.graph;
  LoopCloser trial_closer = closer;
  MapInProgress trial{joined, editor, graph};
  join_by_entries(trial, trial_closer, accepted, mapper);
  const IslandOverlay overlay =
      lay_over(joined, graph, progress.map, joined.island_of(h.a), trial_closer.along(), mapper);
  if (is_contradicted(overlay)) {
    refused_.push_back({{joined.poses().begin(), joined.poses().end()}, contradiction_in_words(overlay)});
    leave_open(closer, accepted, refused_.back().reason);
    return false;
  }
  adopt(progress, joined, h);
  progress.graph = std::move(graph);
  closer = std::move(trial_closer);
  return true;
}

bool JoinTrials::Refused::is_of(const Hypothesis& h) const {
  if (h.b.index() >= T_plane_patch.size()) return false;
  const Pose2 T_a_b = T_plane_patch[h.a.index()].inverse() * T_plane_patch[h.b.index()];
  const Pose2 apart = T_a_b.inverse() * h.T_a_b.T_a_b;
  return apart.distance() < kSamePlacement && std::abs(apart.yaw) < kSamePlacementTurn;
}

}  // namespace helicoid
