#include "helicoid/mapping/local_map.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "helicoid/base/wide_lanes.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/sensor/beam_finder.hpp"

namespace helicoid {

namespace {

/// Turned by a radian, a view has changed as much as over this many metres.
constexpr double kMetresPerRadian = 1.5;

double view_distance(const Pose2& T_anchor_a, const Pose2& T_anchor_b) {
  return (T_anchor_a.translation() - T_anchor_b.translation()).norm() +
         kMetresPerRadian * std::abs(wrap_angle(T_anchor_a.yaw - T_anchor_b.yaw));
}

/// Views no farther apart are as good as one. Where many laps left their patches, the very nearest is another one at
/// every other step.
constexpr double kNearEnough = 0.5;
/// Who stands no farther from his anchor keeps it: another would be no better, and need a local map of its own.
constexpr double kStays = 0.75;

/// Surfaces of a scan that stand for all of them.
constexpr std::size_t kSamples = 24;
/// A surface was seen if the patch measured a range this near to its distance, in metres and of the distance.
constexpr float kRangeTolerance = 0.25F;
constexpr float kRangeShare = 0.03F;
/// Seen flatter than this a surface says little.
constexpr float kLeastFacing = 0.1F;
/// An older patch is preferred if it saw this share of what the best one saw.
constexpr float kMuch = 0.5F;

/// Surfaces of the scan in the anchor's frame; arrays of one length, zero from `size` on.
struct Surfaces {
  std::array<float, kSamples> x{}, y{}, nx{}, ny{};
  std::size_t size = 0;
};

Surfaces sample_surfaces(const ScanPoints& points, const Pose2& T_anchor_robot) {
  Surfaces surfaces;
  const Matrix2d rotation = T_anchor_robot.rotation();
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kSamples);
  for (std::size_t i = stride / 2; i < points.size() && surfaces.size < kSamples; i += stride) {
    if (points.weight[i] <= 0) continue;
    const Vector2d p_anchor = rotation * Vector2d(points.x[i], points.y[i]) + T_anchor_robot.translation();
    const Vector2d normal = rotation * Vector2d(points.nx[i], points.ny[i]);
    surfaces.x[surfaces.size] = static_cast<float>(p_anchor.x());
    surfaces.y[surfaces.size] = static_cast<float>(p_anchor.y());
    surfaces.nx[surfaces.size] = static_cast<float>(normal.x());
    surfaces.ny[surfaces.size++] = static_cast<float>(normal.y());
  }
  return surfaces;
}

/// The surfaces as a laser would meet them; arrays of one length.
struct Sight {
  std::array<float, kSamples> distance;
  std::array<float, kSamples> beam;  ///< -1 where the surface faces away
};

/// Where a laser stands in the anchor's frame.
struct LaserPlace {
  float x, y, cosine, sine;
};

/// All surfaces, whatever is not one: the loop is then one of vectors.
HELICOID_WIDE_LANES
void look_at(const Surfaces& surfaces, LaserPlace at, BeamFinder finder, Sight& sight) {
  for (std::size_t i = 0; i < kSamples; ++i) {
    const float dx = surfaces.x[i] - at.x;
    const float dy = surfaces.y[i] - at.y;
    const float distance = std::sqrt(dx * dx + dy * dy);
    const float facing = -(surfaces.nx[i] * dx + surfaces.ny[i] * dy);
    const float beam = finder.at(at.cosine * dx + at.sine * dy, at.cosine * dy - at.sine * dx);
    sight.distance[i] = distance;
    sight.beam[i] = facing < kLeastFacing * distance ? -1.0F : beam;
  }
}

/// Which of the surfaces a patch saw from their side: bit by bit.
std::uint32_t seen_by(const Patch& patch, const Pose2& T_anchor_patch, const Surfaces& surfaces) {
  const Pose2 T_anchor_laser = T_anchor_patch * patch.scan.T_robot_laser;
  const Eigen::Vector2f at = T_anchor_laser.translation().cast<float>();
  const Eigen::Vector2f ahead = T_anchor_laser.rotation().col(0).cast<float>();
  Sight sight;
  look_at(surfaces, {at.x(), at.y(), ahead.x(), ahead.y()}, BeamFinder(patch.laser), sight);
  const auto beams = static_cast<float>(patch.scan.ranges.size());
  std::uint32_t seen = 0;
  for (std::size_t i = 0; i < surfaces.size; ++i) {
    const float beam = sight.beam[i] + 0.5F;
    if (!(beam >= 0 && beam < beams)) continue;
    const float range = patch.scan.ranges[static_cast<std::size_t>(beam)];
    if (std::abs(range - sight.distance[i]) < kRangeTolerance + kRangeShare * sight.distance[i]) seen |= 1U << i;
  }
  return seen;
}

/// Chooses views one after another: what is seen by few of those chosen so far counts most.
class ViewChoice {
 public:
  explicit ViewChoice(std::vector<std::uint32_t> seen)
      : seen_(std::move(seen)), taken_(seen_.size(), false), gain_(seen_.size(), 0) {
    worth_.fill(1);
  }

  void take(std::size_t i) {
    taken_[i] = true;
    for (std::uint32_t left = seen_[i]; left != 0; left &= left - 1) {
      float& worth = worth_[static_cast<std::size_t>(std::countr_zero(left))];
      worth = 1 / (1 / worth + 1);
    }
  }
  /// What each patch would add, -1 for those that are taken.
  [[nodiscard]] const std::vector<float>& weigh() {
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      gain_[i] = taken_[i] ? -1.0F : 0.0F;
      if (taken_[i]) continue;
      for (std::uint32_t left = seen_[i]; left != 0; left &= left - 1) {
        gain_[i] += worth_[static_cast<std::size_t>(std::countr_zero(left))];
      }
    }
    return gain_;
  }

 private:
  std::vector<std::uint32_t> seen_;
  std::vector<bool> taken_;
  std::vector<float> gain_;
  std::array<float, kSamples> worth_;  ///< of a surface: 1 / (1 + how many of those taken saw it)
};

}  // namespace

LocalMap find_local_map(const Map& map, const InformationGraph& graph, PatchId anchor, const BoundOptions& options) {
  LocalMap local;
  for (const BoundedPose& bounded : joint_bound(graph, map.poses(), anchor.value, options)) {
    local.push_back({PatchId{bounded.pose}, bounded.relative.T_a_b, bounded.relative.covariance});
  }
  return local;
}

LocalMap find_local_map(const Map& map, const InformationGraph& graph, PatchId anchor, const MapperOptions& options) {
  BoundOptions bound =
      bound_options(map.patch(anchor), options.reference_position, options.reference_heading, options.local_radius);
  bound.most = options.local_patches;
  return find_local_map(map, graph, anchor, bound);
}

LocalMap distinct_places(const LocalMap& local, PatchId last_kept) {
  std::vector<std::size_t> oldest_first(local.size());
  std::iota(oldest_first.begin(), oldest_first.end(), 0);
  std::sort(oldest_first.begin(), oldest_first.end(),
            [&](std::size_t i, std::size_t j) { return local[i].patch < local[j].patch; });
  std::vector<bool> is_distinct(local.size(), false);
  std::vector<Pose2> places;
  for (const std::size_t i : oldest_first) {
    const Pose2& T = local[i].T_anchor_patch;
    const auto same = [&](const Pose2& place) {
      const bool is_near = std::abs(place.x - T.x) < kNearEnough && std::abs(place.y - T.y) < kNearEnough;
      return is_near && view_distance(place, T) < kNearEnough;
    };
    is_distinct[i] = std::none_of(places.begin(), places.end(), same);
    if (is_distinct[i]) places.push_back(T);
  }
  LocalMap distinct;
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (i == 0 || is_distinct[i] || local[i].patch == last_kept) distinct.push_back(local[i]);
  }
  return distinct;
}

std::optional<std::size_t> choose_anchor(const Map& map, const LocalMap& local, const Pose2& T_anchor_robot) {
  constexpr double kMuchNearer = 0.8;
  constexpr double kNearer = 0.05;
  const auto knows = [&](const LocalPatch& p) {
    return is_ground(map.patch(p.patch), p.T_anchor_patch.inverse() * T_anchor_robot.translation());
  };
  if (!local.empty() && view_distance(local[0].T_anchor_patch, T_anchor_robot) < kStays && knows(local[0])) return 0;
  std::optional<std::size_t> nearest;
  double least = 0;
  for (std::size_t i = 0; i < local.size(); ++i) {
    double distance = view_distance(local[i].T_anchor_patch, T_anchor_robot);
    if (i == 0) distance = kMuchNearer * distance - kNearer;
    if (nearest && distance >= least) continue;
    if (!knows(local[i])) continue;
    nearest = i;
    least = distance;
  }
  return nearest;
}

std::vector<LocalPatch> nearest_views(const LocalMap& local, const Pose2& T_anchor_robot, std::size_t most) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 0; i < local.size(); ++i) {
    ranked.emplace_back(view_distance(local[i].T_anchor_patch, T_anchor_robot), i);
  }
  const std::size_t count = std::min(most, ranked.size());
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count), ranked.end());
  std::vector<LocalPatch> views;
  for (std::size_t i = 0; i < count; ++i) views.push_back(local[ranked[i].second]);
  return views;
}

std::vector<LocalPatch> select_views(const Map& map, const LocalMap& local, const ScanPoints& points,
                                     const Pose2& T_anchor_robot, PatchId last_kept, std::size_t most) {
  const Surfaces surfaces = sample_surfaces(points, T_anchor_robot);
  std::vector<std::uint32_t> seen;
  for (const LocalPatch& p : local) seen.push_back(seen_by(map.patch(p.patch), p.T_anchor_patch, surfaces));
  ViewChoice choice(std::move(seen));
  std::vector<LocalPatch> views;
  const auto take = [&](std::size_t i) {
    choice.take(i);
    views.push_back(local[i]);
  };
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (local[i].patch == last_kept) take(i);
  }
  while (views.size() < std::min(most, local.size())) {
    const std::vector<float>& gain = choice.weigh();
    const float best_gain = *std::max_element(gain.begin(), gain.end());
    if (best_gain <= 0) break;
    // The nearest of the best and the oldest of the good, in turn.
    const bool oldest = views.size() % 2 == 1;
    const float enough = (oldest ? kMuch : 0.95F) * best_gain;
    const auto order = [&](std::size_t k) {
      return oldest ? static_cast<double>(local[k].patch.value)
                    : view_distance(local[k].T_anchor_patch, T_anchor_robot);
    };
    std::size_t best = local.size();
    double first = HUGE_VAL;
    for (std::size_t i = 0; i < local.size(); ++i) {
      if (gain[i] < enough || order(i) >= first) continue;
      first = order(i);
      best = i;
    }
    take(best);
  }
  return views;
}

std::vector<ReferencePart> reference_parts(const Map& map, std::span<const LocalPatch> views) {
  std::vector<ReferencePart> parts;
  parts.reserve(views.size());
  for (const LocalPatch& view : views) parts.push_back({&map.patch(view.patch).points, view.T_anchor_patch});
  return parts;
}

}  // namespace helicoid
