#include "helicoid/mapping/new_ground.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/sensor/free_space.hpp"

namespace helicoid {

namespace {

/// Patches whose view is tested; the nearest ones cover nearly all.
constexpr std::size_t kMostViews = 12;
constexpr int kSampleBeams = 20;
/// Samples lie at these shares of a beam's free range; each stands for the area about it.
constexpr double kShares[] = {0.45, 0.85};
/// From a corridor most of what is seen is corridor: what is new behind a door stands out only among what is near,
/// metres.
constexpr double kNear = 6;

/// Areas to within a common factor.
struct Areas {
  double covered = 0, uncovered = 0;
  void add(double area, bool is_covered) { (is_covered ? covered : uncovered) += area; }
  [[nodiscard]] double uncovered_share() const {
    return covered + uncovered > 0 ? uncovered / (covered + uncovered) : 0;
  }
};

}  // namespace

bool is_far_from_all(const LocalMap& local, const Pose2& T_anchor_robot, const MapperOptions& options, double share) {
  return std::none_of(local.begin(), local.end(), [&](const LocalPatch& p) {
    const double distance = (p.T_anchor_patch.translation() - T_anchor_robot.translation()).norm();
    return distance < share * options.patch_spacing &&
           std::abs(wrap_angle(p.T_anchor_patch.yaw - T_anchor_robot.yaw)) < share * options.patch_turn;
  });
}

UncoveredShare uncovered_share(const Map& map, const LocalMap& local, const Pose2& T_anchor_robot, const Scan& scan,
                               const ScanPointExtractor& extractor) {
  const std::vector<LocalPatch> views = nearest_views(local, T_anchor_robot, kMostViews);
  std::vector<Pose2> T_patch_laser;
  T_patch_laser.reserve(views.size());
  const Pose2 T_anchor_laser = T_anchor_robot * scan.T_robot_laser;
  for (const LocalPatch& view : views) T_patch_laser.push_back(view.T_anchor_patch.inverse() * T_anchor_laser);
  const auto is_covered = [&](const Vector2d& p_laser) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (contains(map.patch(views[i].patch), T_patch_laser[i] * p_laser)) return true;
    }
    return false;
  };
  const LaserModel& laser = extractor.laser();
  const std::vector<float> radii = free_ranges(scan, laser);
  const int stride = std::max(1, laser.beams / kSampleBeams);
  Areas all, near;
  for (int beam = stride / 2; beam < laser.beams; beam += stride) {
    const Vector2d direction(extractor.beams().cosine[beam], extractor.beams().sine[beam]);
    const double radius = radii[beam];
    if (radius <= 0) continue;
    for (const double share : kShares) {
      const bool covered = is_covered(share * radius * direction);
      all.add(share * radius * radius, covered);
      const bool is_near = radius <= kNear;
      near.add(share * std::min(radius, kNear) * std::min(radius, kNear),
               is_near ? covered : is_covered(share * kNear * direction));
    }
  }
  return {all.uncovered_share(), near.uncovered_share()};
}

bool has_moved(const Pose2& from, const Pose2& to, double distance, double angle) {
  return std::hypot(to.x - from.x, to.y - from.y) > distance || std::abs(wrap_angle(to.yaw - from.yaw)) > angle;
}

}  // namespace helicoid
