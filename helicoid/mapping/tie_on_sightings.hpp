// Robots of one island that see each other (paper IV): a sighting is a relation like any other, wherever the map is not
// confident of one robot's patch relative to the other's.
#pragma once

#include "helicoid/mapping/loop_closer.hpp"
#include "helicoid/mapping/map_in_progress.hpp"
#include "helicoid/mapping/sighting_log.hpp"

namespace helicoid {

/// Looks at the sightings placed since the first `seen`. One that names its robot, measured all three degrees of
/// freedom and agrees with what the map knows (chi^2), ties the two patches, unless the scans about either contradict
/// it or the map is confident of them already (eq. 12). Then fits, and relates what has become related (eq. 16).
/// What an operator accepted ties in any case. True if the map has changed.
bool tie_on_sightings(MapInProgress& progress, LoopCloser& closer, const SightingLog& log, std::size_t seen,
                      const MapperOptions& options);

}  // namespace helicoid
