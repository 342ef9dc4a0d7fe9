// Which sightings of two islands can be true together, and how the islands then lie (design 5.6).
#pragma once

#include "helicoid/fit/local_bound.hpp"
#include "helicoid/mapping/island_join.hpp"

namespace helicoid {

/// A sighting between two islands, if it is of this candidate.
struct SightingOption {
  std::size_t record = 0;     ///< in the log
  std::size_t candidate = 0;  ///< of the record
  PlacedSighting placed;
  bool identified = true;
};

struct SightingConsensus {
  IslandJoin join;
  std::vector<SightingOption> members;  ///< one a record at most
};

/// The sets of them that agree with one relative pose of the islands and determine it: the largest first, of equals
/// that with more identified ones, then that with less chi^2. Starts: each sighting that says all by itself, and the
/// joint optimum of all, those that fit it worst taken out one by one. How far either robot has drifted since is
/// allowed for by the bound of design 5.3.
[[nodiscard]] std::vector<SightingConsensus> find_consensuses(const Map& map, const InformationGraph& graph,
                                                              std::span<const SightingOption> options);

}  // namespace helicoid
