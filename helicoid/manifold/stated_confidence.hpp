// What a map says of where scans lie relative to one another: all that it is uncertain about, in one covariance.
#pragma once

#include <memory>
#include <vector>

#include "helicoid/fit/relative_covariance.hpp"
#include "helicoid/manifold/map.hpp"

namespace helicoid {

struct StatedConfidenceOptions {
  /// A scan is not taken quite at its stamp. What an ordinary drive makes of that is part of the laser's noise floors;
  /// a fast turn makes more of it: this many seconds (one standard deviation) of the robot's motion.
  double timing_sigma = 0.005;
  /// Variance of a heading, as a share of what the graph has it. The laser's kappa is set by positions: an error that
  /// all beams of a surface share shifts a pair and hardly turns it, so that headings are known better than that.
  double heading_share = 0.6;
  /// Of a displacement, what the laser's own measure is off by: ranges and the beams' spacing have errors that no
  /// number of scans averages out. One standard deviation, relative.
  double scale_sigma = 0.002;
};

/// The exact covariance of an island's graph (eq. 9), headings by their share of it, the laser's measure, and once for
/// each end the noise
/// floor of its scan (design 5.3) and what the robot's motion makes of its stamp.
class StatedConfidence {
 public:
  /// The map outlives it.
  StatedConfidence(const Map& map, const Island& island, const StatedConfidenceOptions& options = {});

  /// False if relations leave some patch of the island open: nothing is stated then.
  [[nodiscard]] bool is_determined() const { return exact_.is_determined(); }
  /// Of patch b relative to patch a, in a's frame; both belong to the island.
  [[nodiscard]] UncertainPose2 between(PatchId a, PatchId b) const;

  /// One of a robot's scans, counted from 0.
  struct TakenScan {
    RobotId robot;
    std::size_t index = 0;
  };
  /// Of the robot at scan b relative to the robot at scan a, in the frame of the latter; both stand on the island.
  [[nodiscard]] UncertainPose2 between(const TakenScan& a, const TakenScan& b) const;

 private:
  [[nodiscard]] UncertainPose2 of_patches(PatchId a, PatchId b) const;
  [[nodiscard]] UncertainPose2 with_floors(const UncertainPose2& ab, const TakenScan& a, const TakenScan& b,
                                           const LaserModel& laser_a, const LaserModel& laser_b) const;

  const Map& map_;
  Island island_;
  StatedConfidenceOptions options_;
  RelativeCovariance exact_;
};

/// True if a relative pose is elsewhere by more than is said of it (99 %).
[[nodiscard]] bool is_beyond_said(const UncertainPose2& said, const Pose2& T_a_b);

/// The robot's velocity about one of its scans (v_x, v_y, omega; metres and radians a second, in its own frame), from
/// the nearest scans before and after it between which time enough passed. Zero where the clock does not say.
[[nodiscard]] Vector3d twist_at(const Map& map, const StatedConfidence::TakenScan& scan);

}  // namespace helicoid
