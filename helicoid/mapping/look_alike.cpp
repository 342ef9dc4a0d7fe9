#include "helicoid/mapping/look_alike.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "helicoid/align/place_search.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/told_apart.hpp"

namespace helicoid {

namespace {

/// A candidate may lie this much beyond its window, metres.
constexpr double kMargin = 1;
/// A window is this much wider than it need be, metres.
constexpr double kSlack = 0.3;

/// What the same robot kept just before, nothing if that was its first: to its last one each patch is tied by odometry.
PatchId kept_before(const Map& map, PatchId id) {
  for (const RelationId r : map.relations_of(id)) {
    const Relation& relation = map.relation(r);
    if (relation.kind == RelationKind::odometry && relation.b == id) return relation.a;
  }
  return {};
}

/// b and the patches that its robot kept on the last few metres before it.
std::vector<PatchId> patches_before(const Map& map, PatchId b, const LookAlikeOptions& options) {
  std::vector<PatchId> patches{b};
  double way = 0;
  for (PatchId id = kept_before(map, b); id.valid() && patches.size() < options.place_patches;
       id = kept_before(map, id)) {
    way += (map.T_plane_patch(id).inverse() * map.T_plane_patch(patches.back())).distance();
    if (way > options.place_reach) break;
    patches.push_back(id);
  }
  return patches;
}

double window_of(const UncertainPose2& T, const LookAlikeOptions& options) {
  return options.sigmas / 1.96 * options.drift_inflation * confidence_interval(T.covariance).position;
}

/// How far off the two may lie from where the map has them: offsets p with p^T W^-1 p <= 1, `more` metres added.
Matrix2d window_shape(const UncertainPose2& T, double more, const LookAlikeOptions& options) {
  const double deviations = options.sigmas * options.drift_inflation;
  return deviations * deviations * T.covariance.topLeftCorner<2, 2>() + more * more * Matrix2d::Identity();
}

PlaceWindow window_about(const Candidate& candidate, const LookAlikeOptions& options) {
  PlaceWindow window;
  window.T_reference_scan = candidate.T_a_b.T_a_b;
  window.half_width = std::min(options.widest, window_of(candidate.T_a_b, options) + kSlack);
  window.limit = window_shape(candidate.T_a_b, kSlack, options).inverse();
  window.half_turn =
      std::min(options.widest_turn,
               options.sigmas * options.drift_inflation * std::sqrt(candidate.T_a_b.covariance(2, 2)) + 0.05);
  window.least_score = options.least_search_score;
  return window;
}

}  // namespace

PlaceBefore see_place(const Map& map, PatchId b, const LookAlikeOptions& options) {
  PlaceBefore place{b, views_of_place(map, b, patches_before(map, b, options)), {}};
  place.points = standing_points(map, place.views);
  return place;
}

double farthest_candidate(const LookAlikeOptions& options) {
  return std::max(options.widest + kMargin, options.narrow_reach);
}

std::vector<PatchId> possible_candidates(const Map& map, PatchId b, const LocalMap& known,
                                         const LookAlikeOptions& options) {
  std::vector<PatchId> is_known = patches_before(map, b, options);
  for (const LocalPatch& p : known) is_known.push_back(p.patch);
  std::sort(is_known.begin(), is_known.end());
  std::vector<PatchId> possible = map.patches_about(b, farthest_candidate(options));
  std::erase_if(possible,
                [&](PatchId id) { return b < id || std::binary_search(is_known.begin(), is_known.end(), id); });
  return possible;
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
    // What is known well may show the same walls from some way off.
    const bool is_narrow = confidence_interval(pose.relative.covariance).position <= options.narrow;
    if (distance > std::max(std::min(window, options.widest) + kMargin, is_narrow ? options.narrow_reach : 0.0))
      continue;
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

namespace {

TwoPlaces look_at(const Map& map, const InformationGraph& graph, const Candidate& candidate, const PlaceBefore& place,
                  const MapperOptions& mapper, const LookAlikeOptions& options) {
  TwoPlaces places;
  places.views_b = place.views;
  places.points_b = place.points;
  const bool wide = window_about(candidate, options).half_width > options.wide;
  MapperOptions surroundings = mapper;
  if (wide) surroundings.local_radius = options.wide_reach;
  LocalMap local = find_local_map(map, graph, candidate.a, surroundings);
  std::erase_if(local, [&](const LocalPatch& p) {
    return std::any_of(place.views.begin(), place.views.end(), [&](const LocalPatch& v) { return v.patch == p.patch; });
  });
  places.views_a = nearest_views(local, Pose2{}, wide ? options.wide_views : options.views);
  places.points_a = standing_points(map, places.views_a);
  places.reference.build(reference_parts(map, places.views_a));
  places.align = align_options(map.patch(place.b).laser);
  // The map's own word is no odometry's: what the surfaces leave open stays where the map has it.
  places.align.prior_freedom = kGaussian;
  places.align.kappa *= static_cast<double>(place.views.size());
  return places;
}

/// One way in which the two may lie.
struct Fit {
  Alignment alignment;
  double contradicted = 0;
  bool usable = false;
  /// What speaks for it, less what speaks against it.
  [[nodiscard]] double merit(const LookAlikeOptions& options) const {
    return usable ? alignment.inlier_share * (1 - contradicted / options.most_contradicted) : 0;
  }
};

Fit fit_from(const Map& map, const TwoPlaces& places, const PosePrior& prior, double least_score,
             const LookAlikeOptions& options) {
  Fit fit;
  fit.alignment = align_scan(places.reference, places.points_b, prior, places.align);
  if (!fit.alignment.usable() || fit.alignment.inlier_share < least_score) return fit;
  fit.contradicted = contradicted_share(map, places, fit.alignment.T_reference_scan);
  fit.usable = fit.contradicted < options.most_contradicted;
  return fit;
}

/// True if part of a place fits that is large enough to tell, and next to nothing speaks against it.
bool fits_in_part(const TwoPlaces& places, const Fit& fit, const LookAlikeOptions& options) {
  return fit.alignment.inlier_share * static_cast<double>(places.points_b.size()) >= options.least_part &&
         fit.contradicted < options.most_contradicted_part;
}

/// Where the map itself says how the two lie, part of the place is enough.
Fit fit_near(const Map& map, const TwoPlaces& places, const Candidate& candidate, const LookAlikeOptions& options) {
  const PosePrior prior{candidate.T_a_b.T_a_b, candidate.T_a_b.covariance.inverse()};
  const Fit fit = fit_from(map, places, prior, options.least_score_near, options);
  const bool is_whole = fit.alignment.inlier_share >= options.least_score;
  return is_whole || fits_in_part(places, fit, options) ? fit : Fit{};
}

/// The best fit, and the best of those apart from it.
struct Fits {
  Fit best, second;
  void prefer_better(const LookAlikeOptions& options) {
    if (second.merit(options) > best.merit(options)) std::swap(best, second);
  }
};

Fits search(const Map& map, const TwoPlaces& places, const ScorePyramid& pyramid, const PlaceWindow& window,
            const LookAlikeOptions& options) {
  const PlaceSearch found = search_place(pyramid, places.points_b, window);
  const auto fit_at = [&](const Placement& placement) {
    if (placement.score <= 0) return Fit{};
    return fit_from(map, places, {placement.T_reference_scan, 1e-3 * Matrix3d::Identity()}, options.least_score,
                    options);
  };
  Fits fits{fit_at(found.best), fit_at(found.second)};
  fits.prefer_better(options);
  return fits;
}

/// What fits near where the map has it is believed before what fits at the window's edge; but that is a rival.
Fits search_from_middle(const Map& map, const TwoPlaces& places, const Candidate& candidate,
                        const LookAlikeOptions& options) {
  if (places.reference.empty()) return {};
  const ScorePyramid pyramid(places.reference);
  const PlaceWindow whole = window_about(candidate, options);
  if (whole.half_width <= options.wide) return search(map, places, pyramid, whole, options);
  PlaceWindow middle = whole;
  middle.half_width = std::max(options.wide, whole.half_width / options.sigmas);
  Fits fits = search(map, places, pyramid, middle, options);
  Fits far = search(map, places, pyramid, whole, options);
  if (!fits.best.usable) return far;
  for (const Fit& other : {far.best, far.second}) {
    const Pose2 apart = fits.best.alignment.T_reference_scan.inverse() * other.alignment.T_reference_scan;
    const bool is_other = apart.distance() > whole.apart || std::abs(apart.yaw) > whole.turned_apart;
    if (is_other && other.merit(options) > fits.second.merit(options)) fits.second = other;
  }
  if (fits.second.merit(options) > options.far_more * fits.best.merit(options)) std::swap(fits.best, fits.second);
  return fits;
}

/// True if the two lie as the map had it (chi^2), all three degrees of freedom were matched and next to nothing speaks
/// against it: in a window so small there is no other place to be taken for this one.
bool is_foretold(const Candidate& candidate, const TwoPlaces& places, const Fit& fit, const LookAlikeOptions& options) {
  constexpr double kChi2 = 11.345;  // 99 % at three degrees of freedom
  if (confidence_interval(candidate.T_a_b.covariance).position > options.foretold) return false;
  if (fit.alignment.status != AlignStatus::aligned || !fits_in_part(places, fit, options)) return false;
  const Pose2& T_map = candidate.T_a_b.T_a_b;
  const Pose2& T = fit.alignment.T_reference_scan;
  const Vector3d difference(T.x - T_map.x, T.y - T_map.y, wrap_angle(T.yaw - T_map.yaw));
  return difference.dot(candidate.T_a_b.covariance.inverse() * difference) < kChi2;
}

Matrix3d floor_of(const LaserModel& laser) {
  return noise_floor(laser.floor_position, laser.floor_heading);
}

/// What little was matched in the direction that surfaces leave open is as a rule matched wrongly: it is left out.
Matrix3d without_weakest(const Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix2d> directions(information.topLeftCorner<2, 2>());
  Vector3d open = Vector3d::Zero();
  open.head<2>() = directions.eigenvectors().col(0);
  const Matrix3d kept = Matrix3d::Identity() - open * open.transpose();
  return kept * information * kept;
}

}  // namespace

double merit_of(const Hypothesis& h, const LookAlikeOptions& options) {
  return h.score * std::max(0.0, 1 - h.contradicted / options.most_contradicted);
}

std::optional<Hypothesis> compare_places(const Map& map, const InformationGraph& graph, const Candidate& candidate,
                                         const PlaceBefore& place, const MapperOptions& mapper,
                                         const LookAlikeOptions& options) {
  const TwoPlaces places = look_at(map, graph, candidate, place, mapper, options);
  Fits fits;
  const bool is_searched = confidence_interval(candidate.T_a_b.covariance).position > options.narrow;
  if (is_searched) {
    fits = search_from_middle(map, places, candidate, options);
  } else {
    fits.best = fit_near(map, places, candidate, options);
  }
  const Fit& best = fits.best;
  if (!best.usable) return std::nullopt;
  const Alignment& alignment = best.alignment;

  Hypothesis h;
  h.a = candidate.a;
  h.b = place.b;
  h.ambiguity = std::min(1.0, fits.second.merit(options) / best.merit(options));
  // Where along a bare wall a place lies in a wide window, nothing tells; in a narrow one the map has said it.
  const bool is_open = alignment.status == AlignStatus::degenerate;
  if (is_open && is_searched) return std::nullopt;
  h.T_a_b.T_a_b = alignment.T_reference_scan;
  const Matrix3d information = is_open ? without_weakest(alignment.information) : alignment.information;
  h.T_a_b.covariance = (information / places.align.kappa + 1e-3 * Matrix3d::Identity()).inverse();
  h.T_a_b.covariance =
      with_noise_floor(h.T_a_b, floor_of(map.patch(candidate.a).laser), floor_of(map.patch(place.b).laser));
  h.score = alignment.inlier_share;
  h.contradicted = best.contradicted;
  h.reason = difference_in_words(map, places, {alignment.T_reference_scan, best.contradicted},
                                 {fits.second.alignment.T_reference_scan, fits.second.contradicted});
  h.foretold = is_foretold(candidate, places, best, options);
  return h;
}

}  // namespace helicoid
