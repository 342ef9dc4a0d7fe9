#include "helicoid/mapping/map_in_progress.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

namespace {

/// Along a robot's way; patches nearer than this are one stretch, metres.
constexpr double kStretch = 4;
constexpr int kMinCorrespondences = 40;

/// True if some relation that is not odometry's leads to a patch of that kind.
template <typename IsOfKind>
bool is_matched_to_any(const Map& map, PatchId patch, const IsOfKind& is_of_kind) {
  const std::span<const RelationId> relations = map.relations_of(patch);
  return std::any_of(relations.begin(), relations.end(), [&](RelationId id) {
    const Relation& r = map.relation(id);
    return r.kind != RelationKind::odometry && is_of_kind(r.a == patch ? r.b : r.a);
  });
}

}  // namespace

void MapInProgress::add(const Relation& relation) {
  editor.add_relation(relation);
  graph.add(relation.a.value, relation.b.value, relation.T_a_b,
            expand(relation.form, relation.T_a_b).information / information_divisor(map, relation));
}

bool is_same_stretch(const Map& map, PatchId p, PatchId q, std::span<const double> along) {
  return map.patch(p).robot == map.patch(q).robot && std::abs(along[p.index()] - along[q.index()]) < kStretch;
}

bool are_matched(const Map& map, PatchId p, PatchId q) {
  return is_matched_to_any(map, p, [q](PatchId other) { return other == q; });
}

bool is_tied_to_stretch(const Map& map, PatchId patch, PatchId q, std::span<const double> along) {
  const auto near = [&](PatchId other) { return is_same_stretch(map, other, q, along); };
  return near(patch) || is_matched_to_any(map, patch, near);
}

bool is_untied_ground(const Map& map, PatchId patch, PatchId q, std::span<const double> along, double reach) {
  const Vector2d apart = map.T_plane_patch(q).translation() - map.T_plane_patch(patch).translation();
  return apart.squaredNorm() <= reach * reach && map.island_of(q) == map.island_of(patch) &&
         !is_tied_to_stretch(map, patch, q, along);
}

std::vector<PatchId> older_patches_about(const Map& map, PatchId patch, double reach) {
  std::vector<PatchId> about = map.patches_about(patch, reach);
  about.erase(std::lower_bound(about.begin(), about.end(), patch), about.end());
  return about;
}

RelatedPatch relate_to(MapInProgress& progress, PatchId b, std::span<const LocalPatch> views, const PosePrior& prior,
                       RelationKind kind) {
  RelateOptions options;
  options.min_correspondences = kMinCorrespondences;
  RelatedPatch found = relate(progress.map, views, progress.map.patch(b), prior, options);
  for (Relation& relation : found.relations) {
    relation.kind = kind;
    progress.add(relation);
  }
  return found;
}

}  // namespace helicoid
