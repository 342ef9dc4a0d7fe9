// Where a robot stands: the reference that its scan is matched with, the match, and the patch that it stands on.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "helicoid/align/told_by_one_thing.hpp"
#include "helicoid/mapping/mapper_state.hpp"
#include "helicoid/mapping/new_ground.hpp"

namespace helicoid {

namespace {

// When a match that odometry since the last kept patch contradicts is held against it:
constexpr double kFitsPoorly = 0.75;  // at fewer inliers
constexpr double kAskedEvery = 0.25;  // once in this way, metres
constexpr double kPlainly = 0.2;      // odometry is believed if it explains so much more of the scan

/// True if a place is not where this says that it is, by more than that can well be off.
bool is_elsewhere(const Pose2& T_a_b, const UncertainPose2& said) {
  constexpr double kChi2 = 13.82;  // 99.9 % at two degrees of freedom
  const Matrix2d covariance = said.covariance.topLeftCorner<2, 2>();
  const Vector2d off = T_a_b.translation() - said.T_a_b.translation();
  return off.dot(covariance.inverse() * off) > kChi2;
}

/// True if a match lies elsewhere than odometry can well be off by.
bool contradicts_place(const Alignment& alignment, const PosePrior& prior) {
  return is_elsewhere(alignment.T_reference_scan, {prior.T_reference_scan, prior.information.inverse()});
}

}  // namespace

PosePrior predict(const RobotState& robot, const Motion& motion) {
  const UncertainPose2 T_anchor_now = compound({robot.at.pose.T_patch_robot, robot.at.covariance},
                                               {motion.T_last_now, robot.motion.covariance(motion)});
  return {T_anchor_now.T_a_b, T_anchor_now.covariance.inverse()};
}

void Mapper::State::renew_reference(RobotState& robot, const ScanPoints& points, const Pose2& T_anchor_robot) {
  if (!robot.at.stale && !has_moved(robot.at.T_anchor_reference_view, T_anchor_robot, options.reference_renewal,
                                    options.reference_renewal_turn)) {
    return;
  }
  if (robot.at.stale) {
    robot.at.local = find_local_map(map, graph, robot.at.pose.patch, options);
    robot.at.places = distinct_places(robot.at.local, robot.last_kept);
    robot.at.T_anchor_coverage_view = T_anchor_robot;
    robot.at.stale = false;
  }
  const std::vector<LocalPatch> views =
      select_views(map, robot.at.places, points, T_anchor_robot, robot.last_kept, options.reference_views);
  robot.at.reference.build(reference_parts(map, views));
  robot.at.T_anchor_reference_view = T_anchor_robot;
}

Alignment Mapper::State::match(RobotState& robot, const ScanPoints& points, const PosePrior& prior,
                               const Motion& motion, const LaserModel& laser) {
  const AlignOptions align = align_options(laser);
  Alignment alignment = align_scan(robot.at.reference, points, prior, align);
  const bool is_unusual = alignment.inlier_share < options.usual_inlier_part * robot.usual_share;
  if (robot.motion.is_doubtful(motion) || is_unusual || alignment.inlier_share < options.good_inlier_share) {
    if (const std::optional<Motion> instead = robot.motion.alternative(motion)) {
      const Alignment other = align_scan(robot.at.reference, points, predict(robot, *instead), align);
      if (other.usable() && other.inlier_share > alignment.inlier_share + 0.02) alignment = other;
    }
  }
  if (alignment.usable() && contradicts_place(alignment, prior)) {
    AlignOptions held = align;
    held.prior_freedom = kGaussian;
    const Alignment other = align_scan(robot.at.reference, points, prior, held);
    if (other.usable() &&
        is_told_by_one_thing(robot.at.reference, points, other.T_reference_scan, alignment.T_reference_scan)) {
      alignment = other;
    }
  }
  if (alignment.status == AlignStatus::too_few_inliers || alignment.inlier_share < options.good_inlier_share) {
    const Alignment fan = align_scan_in_fan(robot.at.reference, points, prior, align);
    ++counts.coarse_searches;
    if (fan.usable() && fan.inlier_share > alignment.inlier_share) alignment = fan;
  }
  return alignment;
}

std::optional<Alignment> Mapper::State::match_from(RobotState& robot, const UncertainPose2& T_last_kept_before,
                                                   const ScanPoints& points, PosePrior& prior, const Motion& motion,
                                                   double least, const LaserModel& laser) {
  Standing before = robot.at;
  robot.at.pose = {robot.last_kept, T_last_kept_before.T_a_b};
  robot.at.covariance = T_last_kept_before.covariance;
  robot.at.stale = true;
  const PosePrior there = predict(robot, motion);
  renew_reference(robot, points, there.T_reference_scan);
  const Alignment alignment = match(robot, points, there, motion, laser);
  if (alignment.usable() && alignment.inlier_share > least) {
    prior = there;
    return alignment;
  }
  robot.at = std::move(before);
  return std::nullopt;
}

Alignment Mapper::State::find_robot(RobotState& robot, const ScanPoints& points, PosePrior& prior, const Motion& motion,
                                    const LaserModel& laser) {
  renew_reference(robot, points, prior.T_reference_scan);
  Alignment alignment = match(robot, points, prior, motion, laser);
  const Pose2 T_last_anchor = map.T_plane_patch(robot.last_kept).inverse() * map.T_plane_patch(robot.at.pose.patch);
  if (!alignment.usable() && robot.at.pose.patch != robot.last_kept) {
    // The older ground on which it was taken to stand does not fit: back to the patch that it kept last.
    const UncertainPose2 before{T_last_anchor * robot.at.pose.T_patch_robot,
                                turned(robot.at.covariance, T_last_anchor.yaw)};
    return match_from(robot, before, points, prior, motion, 0, laser).value_or(alignment);
  }
  const bool was_asked = std::abs(robot.since_kept.path - robot.asked_odometry) < kAskedEvery;
  if (!alignment.usable() || alignment.inlier_share > kFitsPoorly || was_asked) return alignment;
  const UncertainPose2 end = robot.since_kept.end(robot.motion);
  if (!is_elsewhere(T_last_anchor * alignment.T_reference_scan, end)) return alignment;
  // A bare corridor fits anywhere along it, and one of its doors holds a robot that drives slowly past.
  robot.asked_odometry = robot.since_kept.path;
  const UncertainPose2 before{end.T_a_b * motion.T_last_now.inverse(), end.covariance};
  return match_from(robot, before, points, prior, motion, alignment.inlier_share + kPlainly, laser).value_or(alignment);
}

Motion Mapper::State::advance(RobotState& robot, const Event& event, const Scan& scan) {
  const Motion motion = robot.motion.advance(scan, event.stamp);
  ++counts.scans;
  if (motion.impossible) ++counts.odometry_jumps;
  if (!scan.has_odometry) ++counts.scans_without_odometry;
  if (!robot.at.pose.patch.valid()) return motion;
  robot.since_kept.add(motion.T_last_now);
  robot.since_known.add(motion.T_last_now);
  return motion;
}

void Mapper::State::follow(RobotState& robot, const Motion& motion, const PosePrior& prior, const Alignment& alignment,
                           const LaserModel& laser) {
  constexpr double kShareMemory = 0.1;
  Pose2& T_anchor_robot = robot.at.pose.T_patch_robot;
  Matrix3d information = prior.information;
  if (alignment.usable()) {
    ++counts.matched;
    robot.motion.learn(motion, T_anchor_robot.inverse() * alignment.T_reference_scan);
    T_anchor_robot = alignment.T_reference_scan;
    information += alignment.information / laser.kappa;
    robot.usual_share += kShareMemory * (alignment.inlier_share - robot.usual_share);
  } else {
    ++counts.predicted;
    T_anchor_robot = prior.T_reference_scan;
  }
  robot.at.covariance = information.inverse();
}

void Mapper::State::note_known_ground(RobotState& robot, const Alignment& alignment) {
  constexpr double kAnew = 3;    // metres
  constexpr double kSure = 0.1;  // of the interval, metres
  if (alignment.status != AlignStatus::aligned || robot.at.pose.patch == robot.last_kept ||
      robot.since_known.path < kAnew) {
    return;
  }
  if (confidence_interval(robot.at.covariance).position > kSure) return;
  robot.since_known = DrivenWay(robot.at.pose, robot.at.covariance);
}

std::optional<LocalPatch> Mapper::State::find_ground(const RobotState& robot) const {
  // Another patch of the same place may know what its oldest does not.
  for (const LocalMap* among : {&robot.at.places, &robot.at.local}) {
    if (const auto ground = choose_anchor(map, *among, robot.at.pose.T_patch_robot)) return (*among)[*ground];
  }
  return std::nullopt;
}

void Mapper::State::stand_on(RobotState& robot, const LocalPatch& ground) {
  if (ground.patch == robot.at.pose.patch) return;
  robot.at.pose = {ground.patch, ground.T_anchor_patch.inverse() * robot.at.pose.T_patch_robot};
  robot.at.covariance = turned(robot.at.covariance, -ground.T_anchor_patch.yaw);
  robot.at.stale = true;
}

}  // namespace helicoid
