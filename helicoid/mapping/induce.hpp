// Loop closure's second half (paper IV-B, eq. 16): a new relation makes formerly unrelated patches confident of one
// another; those that overlap are related in turn, until nothing new is induced.
#pragma once

#include <span>
#include <vector>

#include "helicoid/manifold/map_editor.hpp"
#include "helicoid/mapping/ledger.hpp"
#include "helicoid/mapping/local_map.hpp"
#include "helicoid/mapping/mapper_options.hpp"

namespace helicoid {

/// The map that is being changed and the information of its relations, which must follow.
struct MapInProgress {
  const Map& map;
  MapEditor& editor;
  InformationGraph& graph;
  void add(const Relation& relation);
};

/// Ties b to what lies about a as an accepted hypothesis says. The patches that were related.
std::vector<PatchId> tie(MapInProgress& progress, const Hypothesis& hypothesis, const MapperOptions& options);

/// Eq. 16's queue, from these patches on. `along`: how far along its robot's way each patch was kept, metres: one patch
/// of a stretch is enough to relate to. The patches that were newly related; none if nothing was induced.
std::vector<PatchId> induce(MapInProgress& progress, std::span<const PatchId> begin, std::span<const double> along,
                            const MapperOptions& options);

}  // namespace helicoid
