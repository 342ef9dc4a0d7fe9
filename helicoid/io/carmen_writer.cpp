#include "helicoid/io/carmen_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>

namespace helicoid {

namespace {

void append_pose(std::string& log, const Pose2& pose) {
  fmt::format_to(std::back_inserter(log), " {:.6f} {:.6f} {:.6f}", pose.x, pose.y, pose.yaw);
}

}  // namespace

void append_carmen(std::string& log, const Event& event, const std::string& host) {
  if (const auto* scan = std::get_if<Scan>(&event.body)) {
    fmt::format_to(std::back_inserter(log), "FLASER {}", scan->ranges.size());
    for (const float range : scan->ranges) fmt::format_to(std::back_inserter(log), " {:.2f}", range);
    append_pose(log, scan->T_odom_robot * scan->T_robot_laser);
    append_pose(log, scan->T_odom_robot);
  } else if (const auto* odometry = std::get_if<Odometry>(&event.body)) {
    log += "ODOM";
    append_pose(log, odometry->T_odom_robot);
    log += " 0 0 0";
  } else if (const auto* alike = std::get_if<Lookalike>(&event.body)) {
    fmt::format_to(std::back_inserter(log), "LOOKALIKE {} {:.6f}", alike->robot, alike->stamp);
    append_pose(log, alike->T_there_robot);
    fmt::format_to(std::back_inserter(log), " {:.4f} {:.4f}", alike->sigma_position, alike->sigma_heading);
  } else {
    const auto& s = std::get<Sighting>(event.body);
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    fmt::format_to(std::back_inserter(log), "SIGHTING {} {:.6f} {:.6f} {:.6f} {:.4f} {:.4f} {:.4f}", s.observed,
                   s.range.value_or(kNan), s.bearing.value_or(kNan), s.orientation.value_or(kNan), s.sigma_range,
                   s.sigma_bearing, s.sigma_orientation);
  }
  fmt::format_to(std::back_inserter(log), " {:.6f} {} {:.6f}\n", event.stamp, host, event.stamp);
}

}  // namespace helicoid
