#include "helicoid/mapping/close_loops.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/fit_around.hpp"
#include "helicoid/mapping/induce.hpp"

namespace helicoid {

namespace {

/// Ties b to what lies about a as an accepted hypothesis says. The patches that were related.
std::vector<PatchId> tie(MapInProgress& progress, const Hypothesis& h, const MapperOptions& options) {
  LocalMap local = find_local_map(progress.map, progress.graph, h.a, options);
  std::erase_if(local, [&](const LocalPatch& p) { return p.patch.value >= h.b.value; });
  std::vector<LocalPatch> views =
      select_views(progress.map, local, progress.map.patch(h.b).points, h.T_a_b.T_a_b, h.a, options.relation_views);
  // What is in the map already is not to count twice.
  std::erase_if(views, [&](const LocalPatch& v) { return are_matched(progress.map, h.b, v.patch); });
  const RelatedPatch found =
      relate_to(progress, h.b, views, {h.T_a_b.T_a_b, h.T_a_b.covariance.inverse()}, RelationKind::closure);
  std::vector<PatchId> related{h.b};
  for (const Relation& r : found.relations) related.push_back(r.a);
  return related;
}

/// True if b is neither tied to nor confident of some older patch within reach of it.
bool has_unknown_ground(const Map& map, PatchId b, const LocalMap& known, std::span<const double> along, double reach) {
  const auto is_known = [&](PatchId a) {
    return std::any_of(known.begin(), known.end(), [a](const LocalPatch& p) { return p.patch == a; });
  };
  const std::vector<PatchId> about = older_patches_about(map, b, reach);
  return std::any_of(about.begin(), about.end(),
                     [&](PatchId a) { return !is_known(a) && is_untied_ground(map, b, a, along, reach); });
}

/// How far a patch moved at most, metres.
double farthest_move(const Map& map, std::span<const Pose2> before) {
  double farthest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    farthest = std::max(farthest, (map.poses()[i].translation() - before[i].translation()).norm());
  }
  return farthest;
}

/// True if an accepted hypothesis says of its places what the map says already: what lies about them is related without
/// a fit before it.
bool moves_nothing(const Map& map, const Hypothesis& h) {
  constexpr double kPosition = 0.03;  // metres
  constexpr double kHeading = 0.01;   // radians
  const Pose2 off = h.T_a_b.T_a_b.inverse() * map.T_plane_patch(h.a).inverse() * map.T_plane_patch(h.b);
  return off.distance() < kPosition && std::abs(off.yaw) < kHeading;
}

/// What comes of comparing an older patch's place once more.
std::vector<std::size_t> look_again(const MapInProgress& progress, LoopCloser& closer, PatchId b,
                                    const MapperOptions& options) {
  if (!closer.is_due_again(progress.map, b)) return {};
  const LocalMap known = find_local_map(progress.map, progress.graph, b, options);
  if (!has_unknown_ground(progress.map, b, known, closer.along(), closer.reach_again())) return {};
  return closer.observe_again(progress.map, progress.graph, b, known);
}

}  // namespace

void act_on(MapInProgress& progress, const LoopCloser& closer, std::span<const std::size_t> entries,
            const MapperOptions& options) {
  std::vector<PatchId> touched;
  bool moves = false;
  for (const std::size_t entry : entries) {
    const Hypothesis& h = closer.ledger()[entry];
    moves = moves || !moves_nothing(progress.map, h);
    const std::vector<PatchId> tied = tie(progress, h, options);
    touched.insert(touched.end(), tied.begin(), tied.end());
  }
  if (!moves) touched = induce(progress, touched, closer.along(), options, true);
  spread(progress, closer, std::move(touched), options);
}

void spread(MapInProgress& progress, const LoopCloser& closer, std::vector<PatchId> touched,
            const MapperOptions& options) {
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds && !touched.empty(); ++round) {
    const std::vector<PatchId> moved = fit_around(progress.map, progress.editor, touched);
    // Later rounds move related patches by next to nothing: what their relations say of them stays.
    if (round == 0) renew_information(progress.map, moved, progress.graph);
    touched = induce(progress, touched, closer.along(), options, round == 0);
  }
}

bool close_loops(MapInProgress& progress, LoopCloser& closer, PatchId b, const LocalMap& known,
                 const MapperOptions& options) {
  const std::vector<std::size_t> accepted = closer.observe(progress.map, progress.graph, b, known);
  act_on(progress, closer, accepted, options);
  return !accepted.empty();
}

void close_loops_again(MapInProgress& progress, LoopCloser& closer, const MapperOptions& options) {
  constexpr std::size_t kPasses = 4;
  const Map& map = progress.map;
  const std::size_t patches = map.patch_count();
  std::vector<std::size_t> waiting;
  // What a closure moves may be seen in another light: it ends when nothing has moved since each patch was looked at.
  std::size_t looked_since_move = 0;
  for (std::size_t looked = 0; looked < kPasses * patches && looked_since_move < patches; ++looked) {
    if (looked % patches == 0) closer.start_again(map);
    ++looked_since_move;
    const std::vector<std::size_t> now = look_again(progress, closer, make_id<PatchId>(looked % patches), options);
    waiting.insert(waiting.end(), now.begin(), now.end());
    // What moves the map is acted on at once: from there on fewer ways are left in which places may lie.
    const bool moves = std::any_of(now.begin(), now.end(),
                                   [&](std::size_t entry) { return !moves_nothing(map, closer.ledger()[entry]); });
    if (!moves) continue;
    const std::vector<Pose2> before(map.poses().begin(), map.poses().end());
    act_on(progress, closer, waiting, options);
    waiting.clear();
    if (farthest_move(map, before) >= options.reference_position) looked_since_move = 0;
  }
  if (!waiting.empty()) act_on(progress, closer, waiting, options);
}

}  // namespace helicoid
