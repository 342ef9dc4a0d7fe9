// What a laser measures in a world with people and robots in it.
#pragma once

#include <span>
#include <vector>

#include "helicoid/base/random.hpp"
#include "helicoid/sensor/event.hpp"
#include "helicoid/sensor/laser_model.hpp"
#include "helicoid/simulation/noise.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

/// Something round that stands in the beams' way: a person's legs, another robot.
struct Disc {
  Vector2d centre;
  double radius = 0.2;  ///< metres
};

/// The SICK LMS200 of the simulator: 180 beams over 180 degrees, 81.83 m for "no return".
[[nodiscard]] LaserModel simulated_lms200();

/// What is wrong with one laser for as long as it lives.
struct LaserBias {
  double range = 0;                ///< metres
  double bearing_scale = 0;        ///< relative
  std::vector<double> by_surface;  ///< added to ranges to the walls' segments, in their order; empty: nothing; metres
};

/// By segment of the walls, how much too far it seems: dark surfaces and bright ones.
[[nodiscard]] std::vector<double> draw_materials(std::size_t segments, const LaserNoise& noise, Random random);
[[nodiscard]] LaserBias draw_laser_bias(const LaserNoise& noise, std::vector<double> materials, Random& random);

/// The ranges of one sweep while the laser passes T_world_laser with this twist (metres and radians a second, in its
/// own frame), or is a moment off from there: clocks do not quite agree.
[[nodiscard]] std::vector<float> simulate_ranges(const RayCaster& walls, std::span<const Disc> discs,
                                                 const LaserModel& laser, const Pose2& T_world_laser,
                                                 const Vector3d& twist, const LaserNoise& noise, const LaserBias& bias,
                                                 Random& random);

}  // namespace helicoid
