// Makes one island of two (paper IV-C): a rigid alignment, one relation, and then whatever is induced.
#pragma once

#include "helicoid/mapping/close_loops.hpp"
#include "helicoid/mapping/island_join.hpp"

namespace helicoid {

/// The smaller island moves as a whole to where the join says.
void move_rigidly(MapInProgress& progress, const IslandJoin& join);

/// The island with fewer patches moves; the join becomes a relation.
void join_islands(MapInProgress& progress, LoopCloser& closer, const IslandJoin& join, const MapperOptions& options);

}  // namespace helicoid
