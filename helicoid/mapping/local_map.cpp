#include "helicoid/mapping/local_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

namespace {

/// Turned by a radian, a view has changed as much as over this many metres.
constexpr double kMetresPerRadian = 1.5;

double view_distance(const Pose2& T_anchor_a, const Pose2& T_anchor_b) {
  return std::hypot(T_anchor_a.x - T_anchor_b.x, T_anchor_a.y - T_anchor_b.y) +
         kMetresPerRadian * std::abs(wrap_angle(T_anchor_a.yaw - T_anchor_b.yaw));
}

/// Surfaces of a scan that stand for all of them.
constexpr std::size_t kSamples = 24;
/// A surface was seen if the patch measured a range this near to its distance, in metres and of the distance.
constexpr double kRangeTolerance = 0.25;
constexpr double kRangeShare = 0.03;
/// Seen flatter than this a surface says little.
constexpr double kLeastFacing = 0.1;
/// An older patch is preferred if it saw this share of what the best one saw.
constexpr double kMuch = 0.5;

/// A surface of the scan, in the anchor's frame.
struct Surface {
  Vector2d p_anchor;
  Vector2d normal;
};

std::vector<Surface> sample_surfaces(const ScanPoints& points, const Pose2& T_anchor_robot) {
  std::vector<Surface> surfaces;
  const Matrix2d rotation = T_anchor_robot.rotation();
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kSamples);
  for (std::size_t i = stride / 2; i < points.size() && surfaces.size() < kSamples; i += stride) {
    if (points.weight[i] <= 0) continue;
    surfaces.push_back(
        {T_anchor_robot * Vector2d(points.x[i], points.y[i]), rotation * Vector2d(points.nx[i], points.ny[i])});
  }
  return surfaces;
}

/// Which of the surfaces a patch saw from their side: bit by bit.
std::uint32_t seen_by(const Patch& patch, const Pose2& T_anchor_patch, std::span<const Surface> surfaces) {
  const Pose2 T_anchor_laser = T_anchor_patch * patch.scan.T_robot_laser;
  const Pose2 T_laser_anchor = T_anchor_laser.inverse();
  const Matrix2d rotation = T_laser_anchor.rotation();
  const LaserModel& laser = patch.laser;
  const double middle = laser.first_bearing + 0.5 * laser.field_of_view();
  std::uint32_t seen = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Vector2d p_laser = rotation * surfaces[i].p_anchor + T_laser_anchor.translation();
    const double distance = p_laser.norm();
    const double facing = surfaces[i].normal.dot(T_anchor_laser.translation() - surfaces[i].p_anchor);
    if (facing < kLeastFacing * distance) continue;
    const double offset = wrap_angle(std::atan2(p_laser.y(), p_laser.x()) - middle) + 0.5 * laser.field_of_view();
    const auto beam = std::lround(offset / laser.bearing_step);
    if (beam < 0 || beam >= std::ssize(patch.scan.ranges)) continue;
    const double range = static_cast<double>(patch.scan.ranges[static_cast<std::size_t>(beam)]);
    if (std::abs(range - distance) < kRangeTolerance + kRangeShare * distance) seen |= 1U << i;
  }
  return seen;
}

/// Chooses views one after another: what is seen by few of those chosen so far counts most.
class ViewChoice {
 public:
  explicit ViewChoice(std::vector<std::uint32_t> seen) : seen_(std::move(seen)), taken_(seen_.size(), false) {}

  void take(std::size_t i) {
    taken_[i] = true;
    for (std::size_t k = 0; k < kSamples; ++k) count_[k] += seen_[i] >> k & 1U;
  }
  [[nodiscard]] bool is_taken(std::size_t i) const { return taken_[i]; }
  [[nodiscard]] double gain(std::size_t i) const {
    double gain = 0;
    for (std::size_t k = 0; k < kSamples; ++k) {
      if ((seen_[i] >> k & 1U) != 0) gain += 1.0 / (1 + count_[k]);
    }
    return gain;
  }

 private:
  std::vector<std::uint32_t> seen_;
  std::vector<bool> taken_;
  std::array<std::uint32_t, kSamples> count_{};
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

std::optional<std::size_t> choose_anchor(const Map& map, const LocalMap& local, const Pose2& T_anchor_robot) {
  constexpr double kMuchNearer = 0.8;
  constexpr double kNearer = 0.05;
  std::optional<std::size_t> nearest;
  double least = 0;
  for (std::size_t i = 0; i < local.size(); ++i) {
    double distance = view_distance(local[i].T_anchor_patch, T_anchor_robot);
    if (i == 0) distance = kMuchNearer * distance - kNearer;
    if (nearest && distance >= least) continue;
    const Vector2d p_patch = local[i].T_anchor_patch.inverse() * T_anchor_robot.translation();
    if (!is_ground(map.patch(local[i].patch), p_patch)) continue;
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
  const std::vector<Surface> surfaces = sample_surfaces(points, T_anchor_robot);
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
    double best_gain = 0;
    for (std::size_t i = 0; i < local.size(); ++i) {
      if (!choice.is_taken(i)) best_gain = std::max(best_gain, choice.gain(i));
    }
    if (best_gain <= 0) break;
    // The nearest of the best and the oldest of the good, in turn.
    const bool oldest = views.size() % 2 == 1;
    const double enough = (oldest ? kMuch : 0.95) * best_gain;
    std::size_t best = local.size();
    for (std::size_t i = 0; i < local.size(); ++i) {
      if (choice.is_taken(i) || choice.gain(i) < enough) continue;
      const auto order = [&](std::size_t k) {
        return oldest ? static_cast<double>(local[k].patch.value)
                      : view_distance(local[k].T_anchor_patch, T_anchor_robot);
      };
      if (best == local.size() || order(i) < order(best)) best = i;
    }
    take(best);
  }
  return views;
}

}  // namespace helicoid
