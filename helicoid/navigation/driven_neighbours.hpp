// Neighbours for driving: those of the map, and those between which a robot drove.
#pragma once

#include <utility>
#include <vector>

#include "helicoid/manifold/neighbours.hpp"
#include "helicoid/navigation/trajectory_reader.hpp"

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
  void read(const Map& map);

  TrajectoryReader reader_;
  std::vector<std::pair<PatchId, PatchId>> driven_;  ///< lower id first
};

}  // namespace helicoid
