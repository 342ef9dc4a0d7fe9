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

}  // namespace

bool is_far_from_all(const LocalMap& local, const Pose2& T_anchor_robot, const MapperOptions& options, double share) {
  return std::none_of(local.begin(), local.end(), [&](const LocalPatch& p) {
    const double distance = (p.T_anchor_patch.translation() - T_anchor_robot.translation()).norm();
    return distance < share * options.patch_spacing &&
           std::abs(wrap_angle(p.T_anchor_patch.yaw - T_anchor_robot.yaw)) < share * options.patch_turn;
  });
}

double uncovered_share(const Map& map, const LocalMap& local, const Pose2& T_anchor_robot, const Scan& scan,
                       const ScanPointExtractor& extractor) {
  const std::vector<LocalPatch> views = nearest_views(local, T_anchor_robot, kMostViews);
  std::vector<Pose2> T_patch_laser;
  T_patch_laser.reserve(views.size());
  const Pose2 T_anchor_laser = T_anchor_robot * scan.T_robot_laser;
  for (const LocalPatch& view : views) T_patch_laser.push_back(view.T_anchor_patch.inverse() * T_anchor_laser);
  const LaserModel& laser = extractor.laser();
  const std::vector<float> radii = free_ranges(scan, laser);
  const int stride = std::max(1, laser.beams / kSampleBeams);
  double all = 0;
  double uncovered = 0;
  for (int beam = stride / 2; beam < laser.beams; beam += stride) {
    const double radius = radii[beam];
    if (radius <= 0) continue;
    const double c = extractor.beams().cosine[beam];
    const double s = extractor.beams().sine[beam];
    for (const double share : kShares) {
      const double r = share * radius;
      const double area = r * radius;
      all += area;
      const Vector2d p_laser(r * c, r * s);
      bool covered = false;
      for (std::size_t i = 0; i < views.size() && !covered; ++i) {
        covered = contains(map.patch(views[i].patch), T_patch_laser[i] * p_laser);
      }
      if (!covered) uncovered += area;
    }
  }
  return all > 0 ? uncovered / all : 0;
}

bool has_moved(const Pose2& from, const Pose2& to, double distance, double angle) {
  return std::hypot(to.x - from.x, to.y - from.y) > distance || std::abs(wrap_angle(to.yaw - from.yaw)) > angle;
}

}  // namespace helicoid
