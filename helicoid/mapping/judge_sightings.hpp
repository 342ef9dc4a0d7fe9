// Sightings are held to account by what was mapped later (design 5.6).
#pragma once

#include "helicoid/mapping/sighting_log.hpp"

namespace helicoid {

/// At the end, when all is mapped: every sighting that is still open and whose robots are on one island is accepted or
/// rejected by how it fits the exact covariance.
void judge_sightings(const Map& map, LoopCloser& closer, const SightingLog& log);

/// The accepted sightings that the finished map contradicts, as decisions for another pass over the same events. Of
/// those that merely do not fit it, the worst `most`.
[[nodiscard]] std::vector<Decision> find_regrets(const Map& map, const InformationGraph& graph,
                                                 const LoopCloser& closer, const SightingLog& log, std::size_t most);

}  // namespace helicoid
