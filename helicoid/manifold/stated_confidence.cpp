#include "helicoid/manifold/stated_confidence.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

namespace {

/// A velocity is taken over this time at least, for stamps are jittery, and at most: the clock jumped. Seconds.
constexpr double kShortest = 0.15;
constexpr double kLongest = 2;
/// And over so many scans at most to either side.
constexpr std::size_t kWidest = 5;
/// 99 % of chi square at three degrees of freedom.
constexpr double kBeyond = 11.345;

/// How well a scan is tied to its stamp: the laser's floors, and a moment of the robot's motion.
Matrix3d floor_of(const LaserModel& laser, const Vector3d& twist, double timing_sigma) {
  const Vector3d moved = timing_sigma * twist;
  return noise_floor(laser.floor_position, laser.floor_heading) + moved * moved.transpose();
}

}  // namespace

StatedConfidence::StatedConfidence(const Map& map, const Island& island, const StatedConfidenceOptions& options)
    : map_(map), island_(island), options_(options), exact_(island_poses(map, island), graph_edges(map, island)) {}

UncertainPose2 StatedConfidence::of_patches(PatchId a, PatchId b) const {
  UncertainPose2 stated = exact_.of(island_.place_of(a), island_.place_of(b));
  const Matrix3d scale = Vector3d(1, 1, std::sqrt(options_.heading_share)).asDiagonal();
  stated.covariance = transport(scale, stated.covariance);
  return stated;
}

UncertainPose2 StatedConfidence::between(PatchId a, PatchId b) const {
  const Patch& patch_a = map_.patch(a);
  const Patch& patch_b = map_.patch(b);
  return with_floors(of_patches(a, b), {patch_a.robot, patch_a.scan_index}, {patch_b.robot, patch_b.scan_index},
                     patch_a.laser, patch_b.laser);
}

UncertainPose2 StatedConfidence::between(const TakenScan& a, const TakenScan& b) const {
  const TrackedScan at_a = map_.robot(a.robot).trajectory[a.index];
  const TrackedScan at_b = map_.robot(b.robot).trajectory[b.index];
  const UncertainPose2 in_a{at_a.pose.T_patch_robot, at_a.covariance};
  const UncertainPose2 in_b{at_b.pose.T_patch_robot, at_b.covariance};
  const UncertainPose2 between_patches = of_patches(at_a.pose.patch, at_b.pose.patch);
  return with_floors(compound(compound(invert(in_a), between_patches), in_b), a, b, map_.patch(at_a.pose.patch).laser,
                     map_.patch(at_b.pose.patch).laser);
}

UncertainPose2 StatedConfidence::with_floors(const UncertainPose2& ab, const TakenScan& a, const TakenScan& b,
                                             const LaserModel& laser_a, const LaserModel& laser_b) const {
  const Matrix3d floor_a = floor_of(laser_a, twist_at(map_, a), options_.timing_sigma);
  const Matrix3d floor_b = floor_of(laser_b, twist_at(map_, b), options_.timing_sigma);
  // A displacement of b along its own axes is one of T_a_b turned by its yaw.
  UncertainPose2 stated{ab.T_a_b, with_noise_floor(ab, floor_a, turned(floor_b, ab.T_a_b.yaw))};
  const Vector2d longer = options_.scale_sigma * ab.T_a_b.translation();
  stated.covariance.topLeftCorner<2, 2>() += longer * longer.transpose();
  return stated;
}

bool is_beyond_said(const UncertainPose2& said, const Pose2& T_a_b) {
  return disagreement(said, {T_a_b}) > kBeyond;
}

Vector3d twist_at(const Map& map, const StatedConfidence::TakenScan& scan) {
  const Trajectory& scans = map.robot(scan.robot).trajectory;
  for (std::size_t reach = 1; reach <= kWidest; ++reach) {
    const TrackedScan before = scans[scan.index > reach ? scan.index - reach : 0];
    const TrackedScan after = scans[std::min(scan.index + reach, scans.size() - 1)];
    const double time = after.stamp - before.stamp;
    if (time < kShortest) continue;
    if (time > kLongest || map.island_of(before.pose.patch) != map.island_of(after.pose.patch)) break;
    return logarithm(map.project(before.pose).inverse() * map.project(after.pose)) / time;
  }
  return Vector3d::Zero();
}

}  // namespace helicoid
