#include "helicoid/mapping/close_loops.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <deque>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/fit_islands.hpp"

namespace helicoid {

namespace {

/// True if an older patch lies about b that b is not tied to: without one nothing can be induced.
bool has_untied_ground(const Map& map, PatchId b, std::span<const double> along) {
  for (std::size_t i = 0; i < b.index(); ++i) {
    if (is_untied_ground(map, b, make_id<PatchId>(i), along)) return true;
  }
  return false;
}

/// Step 3 of IV-B for one patch of the queue: nothing if it was related to nothing.
RelatedPatch induce_at(MapInProgress& progress, PatchId b, std::span<const double> along,
                       const MapperOptions& options) {
  if (!has_untied_ground(progress.map, b, along)) return {};
  LocalMap local = find_local_map(progress.map, progress.graph, b, options);
  std::erase_if(local, [&](const LocalPatch& p) {
    return p.patch.value >= b.value || is_tied_to_stretch(progress.map, b, p.patch, along);
  });
  if (local.empty()) return {};
  const std::vector<LocalPatch> views =
      select_views(progress.map, local, progress.map.patch(b).points, Pose2{}, PatchId{}, 2);
  if (views.empty()) return {};
  return relate_to(progress, b, views, {Pose2{}, 1e2 * Matrix3d::Identity()}, RelationKind::overlap);
}

/// Ties b to what lies about a as an accepted hypothesis says. The patches that were related.
std::vector<PatchId> tie(MapInProgress& progress, const Hypothesis& h, const MapperOptions& options) {
  LocalMap local = find_local_map(progress.map, progress.graph, h.a, options);
  std::erase_if(local, [&](const LocalPatch& p) { return p.patch.value >= h.b.value; });
  const std::vector<LocalPatch> views =
      select_views(progress.map, local, progress.map.patch(h.b).points, h.T_a_b.T_a_b, h.a, options.relation_views);
  const RelatedPatch found =
      relate_to(progress, h.b, views, {h.T_a_b.T_a_b, h.T_a_b.covariance.inverse()}, RelationKind::closure);
  std::vector<PatchId> related{h.b};
  for (const NewRelation& r : found.relations) related.push_back(r.patch);
  return related;
}

/// As the queue moves along a way, what was related moves to where it was found, and draws along what is reached next:
/// else a spiral's turns would soon lie too far from one another to be matched before the next fit.
class Zipper {
 public:
  explicit Zipper(MapInProgress& progress) : progress_(progress), moved_(progress.map.patch_count(), false) {}

  /// Puts b where a relation to a patch that was moved says.
  void draw_along(PatchId b) {
    if (moved_[b.index()]) return;
    const Map& map = progress_.map;
    for (const RelationId id : map.relations_of(b)) {
      const Relation& r = map.relation(id);
      const PatchId other = r.a == b ? r.b : r.a;
      if (r.kind == RelationKind::odometry || !moved_[other.index()]) continue;
      move(b, map.T_plane_patch(other) * (r.a == other ? r.T_a_b : r.T_a_b.inverse()));
      return;
    }
  }
  void move(PatchId b, const Pose2& T_plane_b) {
    progress_.editor.set_pose(b, T_plane_b);
    moved_[b.index()] = true;
  }

 private:
  MapInProgress& progress_;
  std::vector<bool> moved_;
};

/// Eq. 16's queue, from these patches on. `along`: how far along its robot's way each patch was kept, metres: one patch
/// of a stretch is enough to relate to. The patches that were newly related; none if nothing was induced.
std::vector<PatchId> induce(MapInProgress& progress, std::span<const PatchId> begin, std::span<const double> along,
                            const MapperOptions& options) {
  std::deque<PatchId> queue;
  std::vector<bool> queued(progress.map.patch_count(), false);
  const auto push = [&](PatchId id) {
    if (queued[id.index()]) return;
    queued[id.index()] = true;
    queue.push_back(id);
  };
  const auto push_related = [&](PatchId id) {
    push(id);
    for (const RelationId r : progress.map.relations_of(id)) {
      push(progress.map.relation(r).a);
      push(progress.map.relation(r).b);
    }
  };
  for (const PatchId id : begin) push_related(id);
  Zipper zipper(progress);
  std::vector<PatchId> touched;
  while (!queue.empty()) {
    const PatchId b = queue.front();
    queue.pop_front();
    zipper.draw_along(b);
    const RelatedPatch found = induce_at(progress, b, along, options);
    if (found.relations.empty()) continue;
    zipper.move(b, progress.map.T_plane_patch(b) * found.T_anchor_patch);
    touched.push_back(b);
    push_related(b);
    for (const NewRelation& r : found.relations) push_related(r.patch);
  }
  return touched;
}

}  // namespace

void act_on(MapInProgress& progress, const LoopCloser& closer, std::span<const std::size_t> entries,
            const MapperOptions& options) {
  constexpr int kRounds = 10;
  std::vector<PatchId> touched;
  for (const std::size_t entry : entries) {
    const std::vector<PatchId> tied = tie(progress, closer.ledger()[entry], options);
    touched.insert(touched.end(), tied.begin(), tied.end());
  }
  for (int round = 0; round < kRounds && !touched.empty(); ++round) {
    fit_islands(progress.map, progress.editor);
    // Later rounds move related patches by next to nothing: what their relations say of them stays.
    if (round == 0) progress.graph = information_graph(progress.map);
    touched = induce(progress, touched, closer.along(), options);
  }
}

bool close_loops(MapInProgress& progress, LoopCloser& closer, PatchId b, const LocalMap& known,
                 const MapperOptions& options) {
  const std::vector<std::size_t> accepted = closer.observe(progress.map, progress.graph, b, known);
  act_on(progress, closer, accepted, options);
  return !accepted.empty();
}

void close_loops_again(MapInProgress& progress, LoopCloser& closer, const MapperOptions& options) {
  constexpr int kPasses = 2;
  for (int pass = 0; pass < kPasses; ++pass) {
    closer.start_again(progress.map);
    std::vector<std::size_t> accepted;
    for (std::size_t i = 0; i < progress.map.patch_count(); ++i) {
      const PatchId b = make_id<PatchId>(i);
      if (!closer.is_due(progress.map, b) || !has_untied_ground(progress.map, b, closer.along())) continue;
      const std::vector<std::size_t> now =
          closer.observe(progress.map, progress.graph, b, find_local_map(progress.map, progress.graph, b, options));
      accepted.insert(accepted.end(), now.begin(), now.end());
    }
    if (accepted.empty()) return;
    act_on(progress, closer, accepted, options);
  }
}

}  // namespace helicoid
