// The relation error of Kuemmerle et al. 2009: how well a trajectory reproduces known relative poses.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// One robot's poses and the frame (island) that they are given in.
struct EvaluatedTrajectory {
  std::string robot;
  int frame = 0;
  std::vector<double> stamps;  ///< seconds, in any order
  std::vector<Pose2> poses;
};

/// The pose of robot b at stamp_b in the frame of robot a at stamp_a. Empty names mean the only trajectory.
struct EvaluatedRelation {
  std::string robot_a;
  double stamp_a = 0;
  std::string robot_b;
  double stamp_b = 0;
  Pose2 T_a_b;
};

struct ErrorStatistics {
  double mean = 0, std = 0, rms = 0, max = 0;
};
[[nodiscard]] ErrorStatistics statistics(std::span<const double> errors);

struct RelationErrorOptions {
  double max_gap = std::numeric_limits<double>::infinity();  ///< score only relations whose stamps differ less, seconds
  bool between_robots = false;                               ///< score only relations of two different robots
  double stamp_tolerance = 5e-6;                             ///< the nearest pose within it counts, seconds
};

struct RelationError {
  std::size_t relations = 0;  ///< that the options ask for
  std::size_t scored = 0;
  std::size_t missing = 0;  ///< no pose at a stamp, or no common frame
  ErrorStatistics translation_m;
  ErrorStatistics rotation_deg;
  std::vector<double> translations_m;  ///< one a scored relation, in order
  std::vector<double> rotations_deg;
};
[[nodiscard]] RelationError relation_error(std::span<const EvaluatedTrajectory> trajectories,
                                           std::span<const EvaluatedRelation> relations,
                                           const RelationErrorOptions& options = {});

}  // namespace helicoid
