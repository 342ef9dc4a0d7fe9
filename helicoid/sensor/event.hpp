// What robots report, in the order in which it counts.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "helicoid/base/ids.hpp"
#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// One sweep of a laser. Within a robot the order of events rules, whatever the stamps say.
struct Scan {
  std::vector<float> ranges;  ///< metres, beam by beam; may hold NaN, infinities and negatives: none is a return
  Pose2 T_odom_robot;         ///< the robot by its odometry when the scan was taken; meaningless if !has_odometry
  Pose2 T_robot_laser;        ///< where the laser sits on the robot
  bool has_odometry = true;
  int laser = 0;  ///< which of the robot's laser models took it
};

/// The robot's odometry between scans.
struct Odometry {
  Pose2 T_odom_robot;
};

/// One robot saw another (the paper's mutual observation, IV). What was not measured is empty.
struct Sighting {
  std::string observed;               ///< the other robot's name; "?" if it was not identified
  std::optional<double> range;        ///< metres
  std::optional<double> bearing;      ///< radians, in the observer's frame
  std::optional<double> orientation;  ///< heading of the observed relative to the observer's, radians
  double sigma_range = 0;
  double sigma_bearing = 0;
  double sigma_orientation = 0;
};

/// Another program's word (a camera that recognises places, say) that the robot is where some robot was.
struct Lookalike {
  std::string robot;          ///< who was there: this robot or another
  double stamp = 0;           ///< when, by that robot's clock, seconds
  Pose2 T_there_robot;        ///< where the robot stands now, seen from there
  double sigma_position = 0;  ///< of either axis, metres
  double sigma_heading = 0;   ///< radians
};

struct Event {
  RobotId robot;
  double stamp = 0;  ///< seconds, of the robot's own clock (CARMEN: ipc time)
  std::variant<Odometry, Scan, Sighting, Lookalike> body;
};

}  // namespace helicoid
