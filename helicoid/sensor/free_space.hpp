// The free space that a scan vouches for: never more than the laser saw.
#pragma once

#include <vector>

#include "helicoid/geometry/pose2.hpp"
#include "helicoid/sensor/event.hpp"
#include "helicoid/sensor/laser_model.hpp"

namespace helicoid {

/// The free-space polygon of a scan (the paper's s, III-A): an open ring of vertices in the robot's frame,
/// anticlockwise, star-shaped about the laser. Empty if the scan vouches for nothing.
/// `T_robot_laser` is where the star's centre lies.
[[nodiscard]] std::vector<Eigen::Vector2f> free_space_polygon(const Scan& scan, const LaserModel& laser,
                                                              const BeamTable& table);

/// How far beam by beam the scan vouches for free space, metres; the polygon's radii.
[[nodiscard]] std::vector<float> free_ranges(const Scan& scan, const LaserModel& laser);

}  // namespace helicoid
