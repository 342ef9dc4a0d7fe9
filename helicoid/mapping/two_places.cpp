#include "helicoid/mapping/two_places.hpp"

#include <algorithm>

#include "helicoid/manifold/seen_free.hpp"

namespace helicoid {

namespace {

/// Points of a place at most; more make it slower, not surer.
constexpr std::size_t kPlacePoints = 700;
/// A point this far within free space contradicts it, metres.
constexpr float kDeep = 0.35F;

/// Which points (in b's frame) lie deep in free space of one of the views.
std::vector<bool> seen_through(const Map& map, std::span<const LocalPatch> views, const ScanPoints& points,
                               const Pose2& T_a_b) {
  std::vector<SeenFreeFrom> from;
  from.reserve(views.size());
  for (const LocalPatch& view : views) {
    from.emplace_back(map.patch(view.patch), view.T_anchor_patch.inverse() * T_a_b);
  }
  std::vector<bool> inside(points.size(), false);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2f p_b(points.x[i], points.y[i]);
    inside[i] =
        std::any_of(from.begin(), from.end(), [&](const SeenFreeFrom& view) { return view.is_deep(p_b, kDeep); });
  }
  return inside;
}

/// The points of views, in the frame that these are given in.
ScanPoints points_of(const Map& map, std::span<const LocalPatch> views) {
  std::size_t all = 0;
  for (const LocalPatch& view : views) all += map.patch(view.patch).points.size();
  const std::size_t stride = std::max<std::size_t>(1, all / kPlacePoints);
  ScanPoints place;
  for (const LocalPatch& view : views) {
    const Eigen::Matrix2f rotation = view.T_anchor_patch.rotation().cast<float>();
    const Eigen::Vector2f offset = view.T_anchor_patch.translation().cast<float>();
    const ScanPoints& points = map.patch(view.patch).points;
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

/// The points that stand and that one of the views saw through.
struct Contradiction {
  double share = 0;
  Vector2d p_points = Vector2d::Zero();  ///< their middle, in the points' frame
};

Contradiction contradiction_in(const Map& map, std::span<const LocalPatch> views, const ScanPoints& points,
                               const Pose2& T_views_points) {
  const std::vector<bool> inside = seen_through(map, views, points, T_views_points);
  std::size_t standing = 0, against = 0;
  Contradiction found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.weight[i] <= 0) continue;
    ++standing;
    if (!inside[i]) continue;
    ++against;
    found.p_points += (Vector2d(points.x[i], points.y[i]) - found.p_points) / static_cast<double>(against);
  }
  found.share = standing > 0 ? static_cast<double>(against) / static_cast<double>(standing) : 0.0;
  return found;
}

}  // namespace

std::vector<LocalPatch> views_of_place(const Map& map, PatchId b, std::span<const PatchId> place) {
  std::vector<LocalPatch> views;
  for (const PatchId id : place) views.push_back({id, map.T_plane_patch(b).inverse() * map.T_plane_patch(id)});
  return views;
}

ScanPoints standing_points(const Map& map, std::span<const LocalPatch> views) {
  ScanPoints points = points_of(map, views);
  const std::vector<bool> moved = seen_through(map, views, points, Pose2{});
  for (std::size_t i = 0; i < points.size(); ++i) points.weight[i] = moved[i] ? 0 : points.weight[i];
  return points;
}

double contradicted_share(const Map& map, const TwoPlaces& places, const Pose2& T_a_b) {
  return std::max(contradiction_in(map, places.views_a, places.points_b, T_a_b).share,
                  contradiction_in(map, places.views_b, places.points_a, T_a_b.inverse()).share);
}

Vector2d middle_of_contradiction(const Map& map, const TwoPlaces& places, const Pose2& T_a_b) {
  const Contradiction now = contradiction_in(map, places.views_a, places.points_b, T_a_b);
  const Contradiction then = contradiction_in(map, places.views_b, places.points_a, T_a_b.inverse());
  return now.share >= then.share ? now.p_points : T_a_b.inverse() * then.p_points;
}

}  // namespace helicoid
