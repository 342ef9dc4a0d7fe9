// Robots of one island that see each other (paper IV): a sighting is a relation like any other, wherever the map is not
// confident of one robot's patch relative to the other's.
#pragma once

#include "helicoid/mapping/loop_closer.hpp"
#include "helicoid/mapping/map_in_progress.hpp"
#include "helicoid/mapping/sighting_log.hpp"

namespace helicoid {

class SightingTies {
 public:
  /// Looks at the sightings placed since the last call. One that names its robot, measured all three degrees of
  /// freedom and agrees with what the map knows (chi^2), ties the two patches, unless the scans about either contradict
  /// it or the map is confident of them already (eq. 12). What an operator accepted ties in any case. Then fits, and
  /// relates what has become related (eq. 16): at once where the map is far off what was seen, else when it is worth a
  /// fit of the whole, or at the `last` call. True if poses have changed.
  bool tie(MapInProgress& progress, LoopCloser& closer, const SightingLog& log, bool last,
           const MapperOptions& options);

 private:
  std::size_t seen_ = 0;       ///< of those that were placed
  std::vector<PatchId> tied_;  ///< since the last fit
  bool fit_now_ = false;
};

}  // namespace helicoid
