// Neighbours for driving: those of the map, and those between which a robot drove.
#pragma once

#include <utility>
#include <vector>

#include "helicoid/manifold/neighbours.hpp"

namespace helicoid {

/// Patches between which a robot passed, from one scan to the next, are neighbours for driving, however badly one is
/// known relative to the other (along a bare corridor, say): it was on both and can go back the way that it came (paper
/// I, retro-traverse). Without them a robot on a patch that is not confident of any other has no way anywhere.
/// Kept from one call to the next; trajectories that are not the ones from before are read anew.
class DrivenNeighbours {
 public:
  /// `neighbours` as find_neighbours has them, and the map's driven ones besides. Ascending.
  [[nodiscard]] Neighbours add_to(const Map& map, Neighbours neighbours);

 private:
  /// Up to where a robot's trajectory was read.
  struct Reader {
    std::size_t scans = 0;
    TrackedScan last;
  };
  [[nodiscard]] bool follows(const Map& map) const;
  void read(const Map& map);

  std::vector<Reader> readers_;
  std::vector<std::pair<PatchId, PatchId>> driven_;  ///< lower id first
};

}  // namespace helicoid
