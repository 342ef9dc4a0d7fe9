// Eq. 16's queue (paper IV-B): a new relation makes formerly unrelated patches confident of one another; those that
// overlap are related in turn, outward from it, until nothing new is induced.
#pragma once

#include "helicoid/mapping/map_in_progress.hpp"

namespace helicoid {

/// Runs the queue from these patches on; `with_related`: and from those that they are related to. `along`: how far
/// along its robot's way each patch was kept, metres: one patch of a stretch is enough to relate to. The patches that
/// were newly related; none if nothing was induced.
std::vector<PatchId> induce(MapInProgress& progress, std::span<const PatchId> begin, std::span<const double> along,
                            const MapperOptions& options, bool with_related);

}  // namespace helicoid
