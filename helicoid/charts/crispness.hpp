// How crisp a sheet is: the share of its walls that are drawn twice.
#pragma once

#include <span>

#include "helicoid/charts/occupancy_grid.hpp"

namespace helicoid {

struct CrispnessOptions {
  double nearest = 0.10;       ///< a twin lies this far behind or before the surface at least, metres
  double farthest = 0.60;      ///< and this far at most, metres
  double same_facing = 0.966;  ///< cosine of the largest angle between the normals of twins (15 degrees)
  double extent = 0.50;        ///< both surfaces run side by side for at least this, metres
  double support = 0.8;        ///< share of that extent on which each is there
};

struct Crispness {
  std::size_t occupied = 0;      ///< occupied cells of the sheet
  std::size_t twins = 0;         ///< those that have a parallel twin, or are one
  std::size_t seen_at_once = 0;  ///< those whose every parallel neighbour some single scan shows beside them: no twins
  double share = 0;              ///< twins / occupied; 0 without occupied cells
};

/// Counts the occupied cells of a sheet that belong to a wall which is drawn twice. The surface of a cell is the mean
/// normal of the patches' points in it, by the side that they face: a wall of any thickness that is seen from both
/// sides is two surfaces that face apart, and no twin. A cell has a twin if, straight along its normal and 0.1-0.6 m
/// away, there is an occupied cell whose surface faces the same way, and both run side by side for half a metre. The
/// farther one then lies where the nearer should have hidden it from every viewer in front of both: no building has
/// that, except for what is seen through (glass, legs of furniture, a door that stands ajar) or moved away between two
/// visits. If a single scan has points on both surfaces, both are there, and the pair is counted apart; of the rest no
/// one can tell what moved from a fault. A step in a wall, a recess or a cupboard is none: its surfaces lie beside one
/// another, not one behind the other. Both members of a pair count. `patches` are those that the grid was drawn from.
[[nodiscard]] Crispness measure_crispness(const Map& map, std::span<const PatchId> patches, const OccupancyGrid& grid,
                                          const CrispnessOptions& options = {});

}  // namespace helicoid
