// Which walls of a building a robot could ever see.
#pragma once

#include <vector>

#include "helicoid/simulation/reachable_floor.hpp"

namespace helicoid {

struct SeenWallOptions {
  double piece = 0.05;                ///< walls are looked at in pieces of at most this length, metres
  double flattest = 0.10;             ///< a surface seen flatter than this counts as not seen, radians
  double reach = 80;                  ///< of the laser, metres
  double direction_step = 0.0349066;  ///< between the directions in which a piece is looked at, radians
};

/// The pieces of wall that a laser at the centre of a robot on this floor can see from somewhere.
[[nodiscard]] std::vector<Segment> find_seen_walls(const World& world, const ReachableFloor& floor,
                                                   const SeenWallOptions& options = {});

}  // namespace helicoid
