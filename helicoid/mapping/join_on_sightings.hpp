// Sightings join islands at once (paper IV-C; design 5.6).
#pragma once

#include "helicoid/mapping/join_islands.hpp"
#include "helicoid/mapping/sighting_log.hpp"

namespace helicoid {

/// To be called when something has become known of sightings: islands that they determine are joined as soon as the
/// scans confirm it, which is at once where two robots see each other and the walls about them. What the scans cannot
/// tell waits for more of them, and is believed at the end (`last`) if it is identified and nothing speaks against it.
/// A robot that was not identified must be confirmed by scans, and no other robot may be. True if islands were joined.
bool join_on_sightings(MapInProgress& progress, LoopCloser& closer, const SightingLog& log, bool last,
                       const MapperOptions& options);

}  // namespace helicoid
