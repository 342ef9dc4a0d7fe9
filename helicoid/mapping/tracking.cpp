// Where a robot stands: the reference that its scan is matched with, the match, and the patch that it stands on.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "helicoid/mapping/mapper_state.hpp"
#include "helicoid/mapping/new_ground.hpp"

namespace helicoid {

PosePrior predict(const RobotState& robot, const Motion& motion) {
  const UncertainPose2 T_anchor_now =
      compound({robot.pose.T_patch_robot, robot.covariance}, {motion.T_last_now, robot.motion.covariance(motion)});
  return {T_anchor_now.T_a_b, T_anchor_now.covariance.inverse()};
}

void Mapper::State::renew_reference(RobotState& robot, const ScanPoints& points, const Pose2& T_anchor_robot) {
  if (!robot.stale && !has_moved(robot.T_anchor_reference_view, T_anchor_robot, options.reference_renewal,
                                 options.reference_renewal_turn)) {
    return;
  }
  if (robot.stale) {
    robot.local = find_local_map(map, graph, robot.pose.patch, options);
    robot.T_anchor_coverage_view = T_anchor_robot;
    robot.stale = false;
  }
  std::vector<ReferencePart> parts;
  for (const LocalPatch& view :
       select_views(map, robot.local, points, T_anchor_robot, robot.last_kept, options.reference_views)) {
    parts.push_back({&map.patch(view.patch).points, view.T_anchor_patch});
  }
  robot.reference.build(parts);
  robot.T_anchor_reference_view = T_anchor_robot;
}

Alignment Mapper::State::match(RobotState& robot, const ScanPoints& points, const PosePrior& prior,
                               const LaserModel& laser) {
  AlignOptions align;
  align.kappa = laser.kappa;
  align.incidence_bias = laser.incidence_bias;
  Alignment alignment = align_scan(robot.reference, points, prior, align);
  if (robot.motion.in_doubt() || alignment.inlier_share < options.good_inlier_share) {
    const Motion steady = robot.motion.constant_velocity();
    const Alignment other = align_scan(robot.reference, points, predict(robot, steady), align);
    if (other.usable() && other.inlier_share > alignment.inlier_share + 0.02) alignment = other;
  }
  if (alignment.status == AlignStatus::too_few_inliers || alignment.inlier_share < options.good_inlier_share) {
    const Alignment fan = align_scan_in_fan(robot.reference, points, prior, align);
    ++counts.coarse_searches;
    if (fan.usable() && fan.inlier_share > alignment.inlier_share) alignment = fan;
  }
  return alignment;
}

/// The older ground on which the robot was taken to stand does not fit: back to the patch that it kept last.
Alignment Mapper::State::match_on_own_way(RobotState& robot, const ScanPoints& points, PosePrior& prior,
                                          const Alignment& failed, const LaserModel& laser) {
  const ManifoldPose pose = robot.pose;
  const Matrix3d covariance = robot.covariance;
  const PosePrior there = prior;
  const Pose2 T_last_anchor = map.T_plane_patch(robot.last_kept).inverse() * map.T_plane_patch(pose.patch);
  robot.pose = {robot.last_kept, T_last_anchor * pose.T_patch_robot};
  robot.covariance = turned(covariance, T_last_anchor.yaw);
  // An information turns as a covariance does.
  prior = {T_last_anchor * there.T_reference_scan, turned(there.information, T_last_anchor.yaw)};
  robot.stale = true;
  renew_reference(robot, points, prior.T_reference_scan);
  Alignment alignment = match(robot, points, prior, laser);
  if (alignment.usable()) return alignment;
  robot.pose = pose;
  robot.covariance = covariance;
  prior = there;
  robot.stale = true;
  renew_reference(robot, points, prior.T_reference_scan);
  return failed;
}

void Mapper::State::reanchor(RobotState& robot) {
  // Eq. 14: the nearest patch of the local map that overlaps; with hysteresis, so that the anchor does not flutter.
  constexpr double kHysteresis = 0.8;
  const std::vector<LocalPatch> nearest = nearest_views(robot.local, robot.pose.T_patch_robot, 1);
  const LocalPatch& best = nearest.front();
  if (best.patch == robot.pose.patch) return;
  const Pose2 T_best_robot = best.T_anchor_patch.inverse() * robot.pose.T_patch_robot;
  const Pose2& T_anchor_robot = robot.pose.T_patch_robot;
  const double now = T_anchor_robot.distance() + 1.5 * std::abs(T_anchor_robot.yaw);
  const double then = T_best_robot.distance() + 1.5 * std::abs(T_best_robot.yaw);
  if (then > kHysteresis * now - 0.05) return;
  robot.pose = {best.patch, T_best_robot};
  robot.covariance = turned(robot.covariance, -best.T_anchor_patch.yaw);
  robot.stale = true;
}

}  // namespace helicoid
