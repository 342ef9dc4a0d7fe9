#include "helicoid/mapping/look_alike.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "helicoid/align/align_scan.hpp"
#include "helicoid/align/place_search.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/manifold/seen_free.hpp"

namespace helicoid {

namespace {

/// Points of a place at most; more make it slower, not surer.
constexpr std::size_t kPlacePoints = 700;
/// A point this far within free space contradicts it, metres.
constexpr float kDeep = 0.35F;

/// b and the patches that its robot kept on the last few metres before it.
std::vector<PatchId> patches_before(const Map& map, PatchId b, const LookAlikeOptions& options) {
  std::vector<PatchId> patches{b};
  double way = 0;
  for (std::size_t i = b.index(); i-- > 0 && patches.size() < options.place_patches;) {
    const PatchId id = make_id<PatchId>(i);
    if (map.patch(id).robot != map.patch(b).robot) continue;
    way += (map.T_plane_patch(id).inverse() * map.T_plane_patch(patches.back())).distance();
    if (way > options.place_reach) break;
    patches.push_back(id);
  }
  return patches;
}

/// Their points in b's frame.
ScanPoints points_of_place(const Map& map, PatchId b, std::span<const PatchId> patches) {
  std::size_t all = 0;
  for (const PatchId id : patches) all += map.patch(id).points.size();
  const std::size_t stride = std::max<std::size_t>(1, all / kPlacePoints);
  ScanPoints place;
  for (const PatchId id : patches) {
    const Pose2 T_b_patch = map.T_plane_patch(b).inverse() * map.T_plane_patch(id);
    const Eigen::Matrix2f rotation = T_b_patch.rotation().cast<float>();
    const Eigen::Vector2f offset = T_b_patch.translation().cast<float>();
    const ScanPoints& points = map.patch(id).points;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      if (points.weight[i] <= 0) continue;
      const Eigen::Vector2f p = rotation * Eigen::Vector2f(points.x[i], points.y[i]) + offset;
      const Eigen::Vector2f n = rotation * Eigen::Vector2f(points.nx[i], points.ny[i]);
      place.x.push_back(p.x());
      place.y.push_back(p.y());
      place.nx.push_back(n.x());
      place.ny.push_back(n.y());
      place.weight.push_back(points.weight[i]);
      place.facing.push_back(points.facing[i]);
      place.beam.push_back(points.beam[i]);
    }
  }
  return place;
}

/// Share of the points (in b's frame) that lie deep in free space of one of the views.
double contradicted_share(const Map& map, std::span<const LocalPatch> views, const ScanPoints& points,
                          const Pose2& T_a_b) {
  std::vector<SeenFree> seen_free;
  std::vector<Pose2> T_view_b;
  seen_free.reserve(views.size());
  T_view_b.reserve(views.size());
  for (const LocalPatch& view : views) {
    seen_free.emplace_back(map.patch(view.patch));
    T_view_b.push_back(view.T_anchor_patch.inverse() * T_a_b);
  }
  std::size_t inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d p_b(points.x[i], points.y[i]);
    for (std::size_t k = 0; k < seen_free.size(); ++k) {
      if (!seen_free[k].is_deep((T_view_b[k] * p_b).cast<float>(), kDeep)) continue;
      ++inside;
      break;
    }
  }
  return points.size() > 0 ? static_cast<double>(inside) / static_cast<double>(points.size()) : 0;
}

double window_of(const UncertainPose2& T, const LookAlikeOptions& options) {
  return options.sigmas / 1.96 * options.drift_inflation * confidence_interval(T.covariance).position;
}

PlaceWindow window_about(const Candidate& candidate, const LookAlikeOptions& options) {
  PlaceWindow window;
  window.T_reference_scan = candidate.T_a_b.T_a_b;
  window.half_width = std::min(options.widest, window_of(candidate.T_a_b, options) + 0.3);
  window.half_turn =
      std::min(options.widest_turn,
               options.sigmas * options.drift_inflation * std::sqrt(candidate.T_a_b.covariance(2, 2)) + 0.05);
  window.least_score = options.least_search_score;
  return window;
}

}  // namespace

ScanPoints points_about(const Map& map, PatchId b, const LookAlikeOptions& options) {
  return points_of_place(map, b, patches_before(map, b, options));
}

std::vector<Candidate> find_candidates(const Map& map, const InformationGraph& graph, PatchId b,
                                       std::span<const BoundedPose> bounds, const LocalMap& known,
                                       const LookAlikeOptions& options) {
  std::vector<bool> is_known(map.patch_count(), false);
  for (const PatchId id : patches_before(map, b, options)) is_known[id.index()] = true;
  for (const LocalPatch& p : known) is_known[p.patch.index()] = true;
  struct Near {
    double distance;
    const BoundedPose* pose;
  };
  std::vector<Near> near;
  for (const BoundedPose& pose : bounds) {
    if (is_known[pose.pose] || pose.pose >= b.value) continue;
    const double distance = pose.relative.T_a_b.distance();
    const double window = window_of(pose.relative, options);
    if (distance > std::min(window, options.widest) + 1.0) continue;
    near.push_back({distance, &pose});
  }
  std::sort(near.begin(), near.end(), [](const Near& x, const Near& y) {
    return x.distance != y.distance ? x.distance < y.distance : x.pose->pose < y.pose->pose;
  });
  std::vector<Candidate> candidates;
  std::vector<bool> same_place(map.patch_count(), false);
  for (const Near& n : near) {
    if (same_place[n.pose->pose]) continue;
    const PatchId a{n.pose->pose};
    candidates.push_back({a, invert(n.pose->relative)});
    if (candidates.size() == options.candidates) break;
    for (const BoundedPose& other : tree_bound(graph, map.poses(), a.value, bound_options(map.patch(a), 0.5, 0.2, 10)))
      same_place[other.pose] = true;
  }
  return candidates;
}

std::optional<Hypothesis> compare_places(const Map& map, const InformationGraph& graph, const Candidate& candidate,
                                         PatchId b, const MapperOptions& mapper, const LookAlikeOptions& options) {
  const std::vector<PatchId> place = patches_before(map, b, options);
  const ScanPoints points = points_of_place(map, b, place);
  LocalMap local = find_local_map(map, graph, candidate.a, mapper);
  std::erase_if(local, [&](const LocalPatch& p) { return std::count(place.begin(), place.end(), p.patch) > 0; });
  const std::vector<LocalPatch> views = nearest_views(local, Pose2{}, options.views);
  Reference reference;
  reference.build(reference_parts(map, views));

  const LaserModel& laser = map.patch(b).laser;
  AlignOptions align = align_options(laser);
  align.kappa *= static_cast<double>(place.size());
  double ambiguity = 0;
  PosePrior prior{candidate.T_a_b.T_a_b, candidate.T_a_b.covariance.inverse()};
  if (confidence_interval(candidate.T_a_b.covariance).position > options.narrow) {
    const PlaceSearch found = search_place(reference, points, window_about(candidate, options));
    if (found.best.score <= 0) return std::nullopt;
    ambiguity = found.second.score / found.best.score;
    prior = {found.best.T_reference_scan, 1e-3 * Matrix3d::Identity()};
  }
  const Alignment alignment = align_scan(reference, points, prior, align);
  if (!alignment.usable() || alignment.inlier_share < options.least_score) return std::nullopt;
  if (alignment.status == AlignStatus::degenerate && ambiguity > 0) return std::nullopt;
  const double contradicted = contradicted_share(map, views, points, alignment.T_reference_scan);
  if (contradicted > options.most_contradicted) return std::nullopt;

  Hypothesis h;
  h.a = candidate.a;
  h.b = b;
  h.T_a_b.T_a_b = alignment.T_reference_scan;
  h.T_a_b.covariance = (alignment.information / align.kappa + 1e-3 * Matrix3d::Identity()).inverse();
  const LaserModel& laser_a = map.patch(candidate.a).laser;
  h.T_a_b.covariance = with_noise_floor(h.T_a_b, noise_floor(laser_a.floor_position, laser_a.floor_heading),
                                        noise_floor(laser.floor_position, laser.floor_heading));
  h.score = alignment.inlier_share;
  h.ambiguity = ambiguity;
  h.contradicted = contradicted;
  return h;
}

}  // namespace helicoid
