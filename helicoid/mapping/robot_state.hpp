// What the mapper keeps of one robot between its scans.
#pragma once

#include <vector>

#include "helicoid/align/reference.hpp"
#include "helicoid/mapping/driven_way.hpp"
#include "helicoid/mapping/local_map.hpp"
#include "helicoid/mapping/seen_robots.hpp"

namespace helicoid {

/// Where a robot stands, and what its scans are matched with there: what a trial match elsewhere changes, and puts
/// back. Poses are in the frame of the anchor, the patch on which the robot stands.
struct Standing {
  ManifoldPose pose;  ///< rho_t; its patch is the anchor
  /// Of pose.T_patch_robot, in the anchor's frame: what the matches have left open so far.
  Matrix3d covariance = Matrix3d::Zero();
  LocalMap local;                 ///< about the anchor
  LocalMap places;                ///< of it what scans are matched with and the robot may stand on
  Reference reference;            ///< in the anchor's frame
  Pose2 T_anchor_reference_view;  ///< from where the reference was chosen
  Pose2 T_anchor_coverage_view;   ///< where coverage was looked at last
  bool stale = true;              ///< the local map and the reference must be made again
};

struct RobotState {
  std::vector<ScanPointExtractor> extractors;  ///< one a laser
  MotionPrior motion;
  Pose2 T_odom_robot;  ///< of the last scan
  SeenRobots seen;     ///< by this robot
  Standing at;
  PatchId last_kept;
  DrivenWay since_kept;    ///< from the last kept patch
  DrivenWay since_known;   ///< the same, or from where the scans last told surely where on older ground the robot stood
  double usual_share = 0;  ///< running mean of the matches' inlier shares
  double asked_odometry = 0;  ///< how far since_kept was when a match was held against odometry last, metres
};

}  // namespace helicoid
