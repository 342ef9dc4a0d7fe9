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

/// The same while robots drive, as proposals that nobody acts on.
class IslandProposals {
 public:
  /// What was mapped since the last call is looked for on all other islands.
  void look(MapInProgress& progress, LoopCloser& closer, const MapperOptions& mapper,
            const IslandEvidenceOptions& options = {});
  /// To be called when islands were joined: proposals that would have joined them otherwise are rejected.
  void answer(const Map& map, LoopCloser& closer, const IslandEvidenceOptions& options = {});

 private:
  [[nodiscard]] std::vector<PatchId> new_places(const Map& map, const LoopCloser& closer,
                                                const IslandEvidenceOptions& options);

  std::vector<double> looked_at_;     ///< by robot: how far along its way it was looked for last, metres
  std::size_t next_ = 0;              ///< patches before it were thought of
  std::vector<std::size_t> waiting_;  ///< in the ledger, between islands
};

/// Acts on entries that were accepted together, of one island or between two: these are brought into rough alignment
/// first (IV-C). What evidence joins must hold all over: islands that so joined contradict each other are left apart,
/// and the entries open. True if the map was changed.
bool act_on_or_join(MapInProgress& progress, LoopCloser& closer, std::span<const std::size_t> accepted,
                    JoinTrials& trials, const MapperOptions& mapper);

}  // namespace helicoid
