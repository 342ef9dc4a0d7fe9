// Is a join outvoted? What robots of two sides saw of each other, counted for the map as it is and for another
// placement.
#pragma once

#include "helicoid/mapping/sighting_log.hpp"

namespace helicoid {

struct SightingVotes {
  std::size_t for_map = 0;    ///< accepted
  std::size_t for_other = 0;  ///< of the others the largest set that agrees on how the sides lie instead
};

/// Of identified sightings that say all by themselves, between a robot of either side. Lies do not agree with one
/// another; truths that a wrong join contradicts do.
[[nodiscard]] SightingVotes count_votes(const Map& map, const Ledger& ledger, const SightingLog& log,
                                        std::span<const RobotId> one_side, std::span<const RobotId> other_side);

}  // namespace helicoid
