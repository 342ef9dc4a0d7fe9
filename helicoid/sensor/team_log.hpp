// What a team of robots without lasers reports: velocities, and range and bearing of marked things, other robots among
// them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace helicoid {

/// The robot's motion from this stamp to the next one.
struct Velocity {
  double stamp = 0;    ///< seconds, of the team's clock
  double forward = 0;  ///< m/s
  double turning = 0;  ///< rad/s, anticlockwise
};

/// A mark that was recognised and measured. Recognition may be wrong, and the mark then another one.
struct Detection {
  double stamp = 0;           ///< seconds, of the team's clock
  std::uint32_t subject = 0;  ///< a robot's place in the team; from the number of robots on a landmark's
  double range = 0;           ///< metres
  double bearing = 0;         ///< radians from the robot's heading, anticlockwise
};

/// Stamps do not step back within either list.
struct TeamRobot {
  std::string name;
  std::vector<Velocity> velocities;
  std::vector<Detection> detections;
};

/// One clock for all; where the robots start and where landmarks stand is not known.
struct TeamLog {
  std::vector<TeamRobot> robots;
  std::vector<std::string> landmarks;  ///< names

  [[nodiscard]] bool is_robot(std::uint32_t subject) const { return subject < robots.size(); }
};

}  // namespace helicoid
