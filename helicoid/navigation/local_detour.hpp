// Round what stands in the way and is not in the map: a person, a teammate.
#pragma once

#include <span>
#include <vector>

#include "helicoid/navigation/live_obstacles.hpp"

namespace helicoid {

struct DetourOptions {
  double radius = 0.25;       ///< kept from everything, metres
  double comfortable = 0.45;  ///< sought, metres
  double to_the_left =
      0.3;  ///< what a metre costs more left of the robot's route, so that two who meet pass, as a share
};

/// The way from the robot (at the origin of its frame) back onto its route beyond what stands on it. `route` is what
/// lies ahead, a few metres, corners in the robot's frame. Empty if there is no way within a few metres.
[[nodiscard]] std::vector<Vector2d> find_detour(const LiveObstacles& obstacles, std::span<const Vector2d> route,
                                                const DetourOptions& options = {});

}  // namespace helicoid
