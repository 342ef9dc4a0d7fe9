#include "helicoid/navigation/where_am_i.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/align/align_scan.hpp"
#include "helicoid/align/place_search.hpp"
#include "helicoid/manifold/seen_free.hpp"

namespace helicoid {

namespace {

/// Points that lie this deep in what a patch saw as free speak against it, metres.
constexpr double kDeep = 0.35;
/// A fit that explains half of the scan is what may be found anywhere.
constexpr double kAnywhere = 0.5;

/// A patch and what its neighbours show about it, in its frame.
struct Surroundings {
  PatchId anchor;
  std::vector<PatchId> views;
  Reference reference;
};

/// Patches that stand for all: each other has one of its neighbours among them within the spacing, looking alike or
/// not.
std::vector<PatchId> choose_anchors(const Map& map, const Neighbours& neighbours, double spacing) {
  std::vector<bool> is_anchor(map.patch_count(), false);
  std::vector<PatchId> anchors;
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const Vector2d here = map.T_plane_patch(make_id<PatchId>(i)).translation();
    const bool has_one = std::any_of(neighbours[i].begin(), neighbours[i].end(), [&](PatchId n) {
      return is_anchor[n.index()] && (map.T_plane_patch(n).translation() - here).norm() < spacing;
    });
    if (has_one) continue;
    is_anchor[i] = true;
    anchors.push_back(make_id<PatchId>(i));
  }
  return anchors;
}

/// The anchor and those of its neighbours that stand nearest to it and look elsewhere than those chosen before.
Surroundings surroundings(const Map& map, const Neighbours& neighbours, PatchId anchor, std::size_t views) {
  Surroundings around{anchor, {anchor}, {}};
  const Pose2 T_anchor_plane = map.T_plane_patch(anchor).inverse();
  std::vector<PatchId> left = neighbours[anchor.index()];
  while (around.views.size() < views && !left.empty()) {
    const auto cost = [&](PatchId id) {
      const Pose2 T_anchor_id = T_anchor_plane * map.T_plane_patch(id);
      double alike = 0;
      for (const PatchId view : around.views) {
        const Pose2 T_view_id = map.T_plane_patch(view).inverse() * map.T_plane_patch(id);
        alike = std::max(alike, std::cos(T_view_id.yaw) - 0.5 * T_view_id.distance());
      }
      return T_anchor_id.distance() + 2 * alike;
    };
    const auto best =
        std::min_element(left.begin(), left.end(), [&](PatchId a, PatchId b) { return cost(a) < cost(b); });
    around.views.push_back(*best);
    left.erase(best);
  }
  std::vector<ReferencePart> parts;
  parts.reserve(around.views.size());
  for (const PatchId id : around.views)
    parts.push_back({&map.patch(id).points, T_anchor_plane * map.T_plane_patch(id)});
  around.reference.build(parts);
  return around;
}

struct Fit {
  PatchId anchor;
  Placement placement;
};

std::vector<Fit> search_everywhere(const Map& map, const Neighbours& neighbours, const ScanPoints& points,
                                   const WhereAmIOptions& options) {
  PlaceWindow window;
  window.half_width = options.reach;
  window.half_turn = std::numbers::pi;
  window.turn_step = 0.05;
  window.least_score = options.least_score;
  std::vector<Fit> fits;
  for (const PatchId anchor : choose_anchors(map, neighbours, options.spacing)) {
    const PlaceSearch found =
        search_place(surroundings(map, neighbours, anchor, options.views).reference, points, window);
    for (const Placement& placement : {found.best, found.second}) {
      if (placement.score >= options.least_score) fits.push_back({anchor, placement});
    }
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const Fit& a, const Fit& b) { return a.placement.score > b.placement.score; });
  return fits;
}

/// Aligned to what is about the place, and asked what speaks against it.
PlaceHypothesis refine(const Map& map, const Surroundings& around, const Placement& placement, const ScanPoints& points,
                       const LaserModel& laser) {
  const Alignment alignment =
      align_scan(around.reference, points, {placement.T_reference_scan, Matrix3d::Identity()}, align_options(laser));
  PlaceHypothesis place;
  if (!alignment.usable()) return place;
  place.pose = {around.anchor, alignment.T_reference_scan};
  place.inlier_share = alignment.inlier_share;
  int against = 0;
  for (const PatchId id : around.views) {
    const Pose2 T_id_scan =
        map.T_plane_patch(id).inverse() * map.T_plane_patch(around.anchor) * place.pose.T_patch_robot;
    against = std::max(against, count_contradictions(map.patch(id), points, T_id_scan, kDeep));
  }
  place.against_share = static_cast<double>(against) / static_cast<double>(std::max<std::size_t>(1, points.size()));
  return place;
}

bool is_same_place(const Map& map, const PlaceHypothesis& a, const PlaceHypothesis& b, const Neighbours& neighbours,
                   const WhereAmIOptions& options) {
  if (map.island_of(a.pose.patch) != map.island_of(b.pose.patch)) return false;
  const std::vector<PatchId>& of_a = neighbours[a.pose.patch.index()];
  const bool one_sheet = a.pose.patch == b.pose.patch || std::binary_search(of_a.begin(), of_a.end(), b.pose.patch);
  const Pose2 T_a_b = map.project(a.pose).inverse() * map.project(b.pose);
  return one_sheet && T_a_b.distance() < options.apart && std::abs(T_a_b.yaw) < options.apart_heading;
}

/// Whether a dozen beams in a row meet a surface that is known is one question: they look at one thing.
constexpr double kBeamsOfOneThing = 12;

/// By how much better each explains the scan than the others, and than a place that nobody has seen would.
void share_confidence(std::vector<PlaceHypothesis>& places, std::size_t points) {
  const double independent = static_cast<double>(points) / kBeamsOfOneThing;
  const auto fitness = [](const PlaceHypothesis& p) { return p.inlier_share - p.against_share; };
  double sum = std::exp(kAnywhere * independent);
  for (PlaceHypothesis& place : places) sum += place.confidence = std::exp(fitness(place) * independent);
  for (PlaceHypothesis& place : places) place.confidence /= sum;
}

}  // namespace

std::vector<PlaceHypothesis> where_am_i(const Map& map, const Neighbours& neighbours, const Scan& scan,
                                        const LaserModel& laser, const WhereAmIOptions& options) {
  ScanPointExtractor extractor(laser);
  const ScanPoints& points = extractor.extract(scan);
  std::vector<PlaceHypothesis> places;
  if (points.size() < static_cast<std::size_t>(AlignOptions{}.min_points)) return places;
  for (const Fit& fit : search_everywhere(map, neighbours, points, options)) {
    if (places.size() >= options.refined) break;
    const Surroundings around = surroundings(map, neighbours, fit.anchor, options.views);
    const PlaceHypothesis place = refine(map, around, fit.placement, points, laser);
    if (!place.pose.patch.valid()) continue;
    const auto same = std::find_if(places.begin(), places.end(), [&](const PlaceHypothesis& other) {
      return is_same_place(map, place, other, neighbours, options);
    });
    if (same == places.end()) {
      places.push_back(place);
    } else if (place.inlier_share - place.against_share > same->inlier_share - same->against_share) {
      *same = place;
    }
  }
  share_confidence(places, points.size());
  std::stable_sort(places.begin(), places.end(),
                   [](const PlaceHypothesis& a, const PlaceHypothesis& b) { return a.confidence > b.confidence; });
  return places;
}

std::optional<ManifoldPose> find_on_sheet(const Map& map, const Neighbours& neighbours, PatchId patch,
                                          const ManifoldPose& robot, const Scan& scan, const LaserModel& laser,
                                          const SheetSearchOptions& options) {
  ScanPointExtractor extractor(laser);
  const ScanPoints& points = extractor.extract(scan);
  if (points.size() < static_cast<std::size_t>(AlignOptions{}.min_points)) return std::nullopt;
  const WhereAmIOptions about;
  PlaceWindow window;
  window.T_reference_scan = map.express(robot, patch).T_patch_robot;
  window.half_width = options.reach;
  window.half_turn = options.turn;
  const Surroundings around = surroundings(map, neighbours, patch, about.views);
  const PlaceSearch found = search_place(around.reference, points, window);
  if (found.best.score < std::max(about.least_score, options.clearer * found.second.score)) return std::nullopt;
  const PlaceHypothesis place = refine(map, around, found.best, points, laser);
  const bool fits = place.pose.patch.valid() && place.inlier_share >= options.least_inlier_share &&
                    place.against_share <= options.most_against;
  return fits ? std::optional(place.pose) : std::nullopt;
}

}  // namespace helicoid
