// Do two islands show the same building? Places of one are looked for all over the other (design 5.6).
#pragma once

#include "helicoid/mapping/join_islands.hpp"
#include "helicoid/mapping/join_on_trial.hpp"

namespace helicoid {

struct IslandEvidenceOptions {
  double place_spacing = 4;          ///< along the way of the smaller island, metres
  std::size_t most_places = 48;      ///< of an island; spread over it
  double least_score = 0.72;         ///< of a placement
  double turn_step = 0.05;           ///< radians
  double placed_within = 0.3;        ///< how well a search says where a place is, metres
  double placed_within_turn = 0.06;  ///< radians
};

/// Enters into the ledger where places of each smaller island may lie on each larger one. With `may_join`, islands are
/// joined where enough of them agree; else they stay proposals. True if islands were joined.
bool join_on_evidence(MapInProgress& progress, LoopCloser& closer, bool may_join, const MapperOptions& mapper,
                      const IslandEvidenceOptions& options = {});

/// Acts on entries that were accepted together, of one island or between two: these are brought into rough alignment
/// first (IV-C). What evidence joins must hold all over: islands that so joined contradict each other are left apart,
/// and the entries open. True if the map was changed.
bool act_on_or_join(MapInProgress& progress, LoopCloser& closer, std::span<const std::size_t> accepted,
                    JoinTrials& trials, const MapperOptions& mapper);

}  // namespace helicoid
