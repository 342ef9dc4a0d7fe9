// Fiducials on robots, and who can see whose.
#pragma once

#include <numbers>
#include <optional>
#include <span>
#include <string>

#include "helicoid/base/random.hpp"
#include "helicoid/sensor/event.hpp"
#include "helicoid/simulation/laser_simulator.hpp"
#include "helicoid/simulation/noise.hpp"

namespace helicoid {

struct SightingLimits {
  double range = 8;                ///< metres
  double view = std::numbers::pi;  ///< the camera's whole field of view, ahead; radians
};

/// Whether a wall or a disc stands between two points; a disc about `to` hides nothing.
[[nodiscard]] bool is_hidden(const RayCaster& walls, std::span<const Disc> discs, const Vector2d& from,
                             const Vector2d& to);

/// What a robot reports of another one; empty if it is too far or too near, out of view or hidden.
[[nodiscard]] std::optional<Sighting> simulate_sighting(const RayCaster& walls, std::span<const Disc> discs,
                                                        const Pose2& T_world_observer, const Pose2& T_world_observed,
                                                        const std::string& observed, const SightingLimits& limits,
                                                        const SightingNoise& noise, Random& random);

}  // namespace helicoid
