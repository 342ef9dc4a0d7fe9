// Loop closure's second half (paper IV-B, eq. 16): a new relation makes formerly unrelated patches confident of one
// another; those that overlap are related in turn, until nothing new is induced.
#pragma once

#include "helicoid/mapping/loop_closer.hpp"
#include "helicoid/mapping/map_in_progress.hpp"

namespace helicoid {

/// Ties what these entries of the ledger say, fits, and relates what has become related until nothing is induced any
/// more.
void act_on(MapInProgress& progress, const LoopCloser& closer, std::span<const std::size_t> entries,
            const MapperOptions& options);

/// Fits after these patches were newly tied, and relates what has become related until nothing is induced any more.
void spread(MapInProgress& progress, const LoopCloser& closer, std::vector<PatchId> touched,
            const MapperOptions& options);

/// After patch b was kept: acts on what the closer accepts now, fits, and relates what has become related (eq. 16's
/// queue) until nothing is induced any more. True if the map has changed.
bool close_loops(MapInProgress& progress, LoopCloser& closer, PatchId b, const LocalMap& known,
                 const MapperOptions& options);

/// The same for all patches once more, now that more is known of each, until a pass moves nothing by more than eq. 12
/// allows.
void close_loops_again(MapInProgress& progress, LoopCloser& closer, const MapperOptions& options);

}  // namespace helicoid
