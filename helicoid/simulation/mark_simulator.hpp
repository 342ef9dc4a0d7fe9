// Robots without lasers on an open floor: they are told velocities and do not quite follow, and they measure range and
// bearing to marks on landmarks and on one another.
#pragma once

#include <cstdint>
#include <vector>

#include "helicoid/geometry/pose2.hpp"
#include "helicoid/sensor/team_log.hpp"

namespace helicoid {

struct MarkSimulation {
  std::uint64_t seed = 1;
  int robots = 5;
  int landmarks = 12;
  double seconds = 300;
  double width = 6;              ///< of the floor, metres
  double height = 10;            ///< metres
  double speed = 0.15;           ///< m/s
  double view = 0.6;             ///< to either side of the heading, radians
  double range = 6;              ///< metres
  double rate = 3;               ///< looks a second
  double seen = 0.5;             ///< share of what is in view that is recognised
  double wrong = 0;              ///< share of recognised marks that are taken for any other one
  double range_share = 0.04;     ///< standard deviation of a range, of it
  double bearing_sigma = 0.008;  ///< radians
  double forward_gain = 0.92;    ///< metres driven per metre told, on average over robots
  double turning_gain = 0.9;     ///< radians turned per radian told, likewise
  double delay = 0.2;            ///< seconds from telling to doing
  double turning_share = 0.005;  ///< variance of a turn, rad^2 per radian
  double forward_rate = 2e-4;    ///< variance of a way, m^2/s
};

struct SimulatedTeam {
  TeamLog log;
  std::vector<double> stamps;             ///< of the truth, 10 a second
  std::vector<std::vector<Pose2>> truth;  ///< T_world_robot, by robot
  std::vector<Vector2d> landmarks;        ///< in the world
  std::size_t wrong = 0;                  ///< detections whose mark is another one
};

/// The same options give the same team.
[[nodiscard]] SimulatedTeam simulate_marks(const MarkSimulation& options);

}  // namespace helicoid
