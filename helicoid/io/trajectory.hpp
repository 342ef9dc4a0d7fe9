// Trajectories in TUM's format: `t x y z qx qy qz qw`, one pose a line.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/geometry/pose2.hpp"
#include "helicoid/io/skipped.hpp"

namespace helicoid {

struct StampedPose {
  double stamp = 0;  ///< seconds
  Pose2 pose;        ///< of the robot
};

/// `t x y 0 0 0 qz qw` lines, t to the microsecond, lengths to the micrometre.
[[nodiscard]] std::string to_tum(std::span<const StampedPose> trajectory);

struct TumFile {
  std::vector<StampedPose> poses;
  std::vector<Skipped> skipped;
};
/// Reads TUM lines, plain or gzipped; lines that are none are counted. Error: no pose in the file.
[[nodiscard]] Result<TumFile> read_tum(const std::string& path);
[[nodiscard]] TumFile parse_tum(const std::string& text, const std::string& name);

}  // namespace helicoid
