#include "helicoid/mapping/induce.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <deque>

#include "helicoid/align/align_scan.hpp"
#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

namespace {

/// Where a corridor leaves its direction weak, no single way is confident (eq. 12) of the next lap for long. What is
/// known to this many times the limits is aligned first, from there.
constexpr double kWide = 2;
constexpr double kLeastScore = 0.75;  ///< inlier share of that alignment
/// A patch that so many older ones of other passages are related to needs no more of them.
constexpr int kTies = 3;
/// Patches that another is related to at once, before those of one stretch are reduced to one.
constexpr std::size_t kViews = 10;

struct Induced {
  std::vector<PatchId> related;
  Pose2 T_plane_patch;
};

Induced induced_by(const Map& map, PatchId anchor, const RelatedPatch& found) {
  Induced induced{{}, map.T_plane_patch(anchor) * found.T_anchor_patch};
  for (const Relation& r : found.relations) induced.related.push_back(r.a);
  return induced;
}

bool has_enough_ties(const Map& map, PatchId b, std::span<const double> along, const MapperOptions& options) {
  const auto is_of_this_passage = [&](PatchId a) {
    return map.patch(a).robot == map.patch(b).robot &&
           std::abs(along[a.index()] - along[b.index()]) <= options.local_radius;
  };
  const std::span<const RelationId> relations = map.relations_of(b);
  return std::count_if(relations.begin(), relations.end(), [&](RelationId id) {
           const Relation& r = map.relation(id);
           return r.b == b && r.kind != RelationKind::odometry && !is_of_this_passage(r.a);
         }) >= kTies;
}

/// One of each stretch of way, the first.
std::vector<LocalPatch> one_of_each_stretch(const Map& map, std::span<const LocalPatch> views,
                                            std::span<const double> along) {
  std::vector<LocalPatch> chosen;
  for (const LocalPatch& v : views) {
    const bool has_one = std::any_of(chosen.begin(), chosen.end(), [&](const LocalPatch& c) {
      return is_same_stretch(map, c.patch, v.patch, along);
    });
    if (!has_one) chosen.push_back(v);
  }
  return chosen;
}

/// Steps 3 to 5 of IV-B where b is confident of what lies about it.
Induced relate_to_known(MapInProgress& progress, PatchId b, const LocalMap& known, std::span<const double> along) {
  const Map& map = progress.map;
  const std::vector<LocalPatch> views =
      one_of_each_stretch(map, select_views(map, known, map.patch(b).points, Pose2{}, PatchId{}, kViews), along);
  if (views.empty()) return {};
  return induced_by(map, b,
                    relate_to(progress, b, views, {Pose2{}, 1e2 * Matrix3d::Identity()}, RelationKind::overlap));
}

/// The same where it is not: b is first aligned with what lies about the patch that it knows best.
Induced relate_by_alignment(MapInProgress& progress, PatchId b, const LocalPatch& best, std::span<const double> along,
                            const MapperOptions& options) {
  const Map& map = progress.map;
  const Patch& patch = map.patch(b);
  const UncertainPose2 T_a_b = invert({best.T_anchor_patch, best.covariance});
  LocalMap local = find_local_map(map, progress.graph, best.patch, options);
  std::erase_if(local, [&](const LocalPatch& p) { return p.patch.value >= b.value; });
  std::vector<LocalPatch> views =
      select_views(map, local, patch.points, T_a_b.T_a_b, best.patch, options.relation_views);
  Reference reference;
  reference.build(reference_parts(map, views));
  const Matrix3d information = T_a_b.covariance.inverse();
  const Alignment found = align_scan(reference, patch.points, {T_a_b.T_a_b, information}, align_options(patch.laser));
  if (!found.usable() || found.inlier_share < kLeastScore) return {};
  std::erase_if(views, [&](const LocalPatch& v) { return is_tied_to_stretch(map, b, v.patch, along); });
  return induced_by(map, best.patch,
                    relate_to(progress, b, views, {found.T_reference_scan, information}, RelationKind::closure));
}

/// True if an older patch lies about b that b is not tied to: without one nothing can be induced.
bool has_untied_ground(const Map& map, PatchId b, std::span<const double> along) {
  const std::vector<PatchId> about = older_patches_about(map, b);
  return std::any_of(about.begin(), about.end(), [&](PatchId a) { return is_untied_ground(map, b, a, along); });
}

/// One patch of the queue: nothing if it was related to nothing.
Induced induce_at(MapInProgress& progress, PatchId b, std::span<const double> along, const MapperOptions& options) {
  const Map& map = progress.map;
  if (has_enough_ties(map, b, along, options) || !has_untied_ground(map, b, along)) return {};
  BoundOptions bound = bound_options(map.patch(b), kWide * options.reference_position,
                                     kWide * options.reference_heading, options.local_radius);
  bound.most = options.local_patches;
  LocalMap local = find_local_map(map, progress.graph, b, bound);
  std::erase_if(local, [&](const LocalPatch& p) {
    return p.patch.value >= b.value || !is_untied_ground(map, b, p.patch, along);
  });
  if (local.empty()) return {};
  const auto interval = [](const LocalPatch& p) { return confidence_interval(p.covariance); };
  LocalMap known;
  std::copy_if(local.begin(), local.end(), std::back_inserter(known), [&](const LocalPatch& p) {
    return interval(p).position < options.reference_position && interval(p).heading < options.reference_heading;
  });
  Induced induced = relate_to_known(progress, b, known, along);
  if (!induced.related.empty()) return induced;
  const auto best = std::min_element(local.begin(), local.end(), [&](const LocalPatch& x, const LocalPatch& y) {
    return interval(x).position < interval(y).position;
  });
  return relate_by_alignment(progress, b, *best, along, options);
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

}  // namespace

std::vector<PatchId> induce(MapInProgress& progress, std::span<const PatchId> begin, std::span<const double> along,
                            const MapperOptions& options, bool with_related) {
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
  for (const PatchId id : begin) with_related ? push_related(id) : push(id);
  Zipper zipper(progress);
  std::vector<PatchId> touched;
  while (!queue.empty()) {
    const PatchId b = queue.front();
    queue.pop_front();
    zipper.draw_along(b);
    const Induced found = induce_at(progress, b, along, options);
    if (found.related.empty()) continue;
    zipper.move(b, found.T_plane_patch);
    touched.push_back(b);
    push_related(b);
    for (const PatchId r : found.related) push_related(r);
  }
  return touched;
}

}  // namespace helicoid
