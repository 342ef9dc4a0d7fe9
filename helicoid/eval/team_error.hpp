// Several robots' trajectories against true ones, after one rigid transform for all of them together.
#pragma once

#include <span>
#include <vector>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// One robot's estimate and its true way, both in order of time; stamps in seconds.
struct TeamTrack {
  std::vector<double> stamps;
  std::vector<Pose2> poses;  ///< T_plane_robot
  std::vector<double> true_stamps;
  std::vector<Pose2> truth;  ///< T_world_robot
};

struct TeamError {
  std::size_t matched = 0;  ///< poses with a true one
  double rms_m = 0;         ///< distance, after T_world_plane
  double max_m = 0;
  double rms_deg = 0;            ///< difference of headings
  Pose2 T_world_plane;           ///< the best, least squares of positions
  std::vector<double> robots_m;  ///< rms by robot; 0 for one without a match
};

/// The truth at a stamp is interpolated between its neighbours, if they are at most `gap` seconds apart.
[[nodiscard]] TeamError team_error(std::span<const TeamTrack> tracks, double gap = 0.25);

}  // namespace helicoid
