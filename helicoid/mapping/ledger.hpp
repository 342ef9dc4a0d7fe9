// The ledger of evidence (design 5.6): what may be the same place, and what was decided about it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "helicoid/base/ids.hpp"
#include "helicoid/geometry/covariance.hpp"

namespace helicoid {

enum class HypothesisState : std::uint8_t { open, accepted, rejected, distinct };
[[nodiscard]] const char* name_of(HypothesisState state);

enum class HypothesisSource : std::uint8_t { lookalike, sighting, operator_ };
[[nodiscard]] const char* name_of(HypothesisSource source);

/// Who gave an entry its state.
enum class DecidedBy : std::uint8_t { nobody, evidence, sighting, operator_ };
[[nodiscard]] const char* name_of(DecidedBy who);

/// What an entry of a sighting was made from.
struct SeenRobot {
  RobotId observer;
  double stamp = 0;            ///< seconds, of the observer's clock
  std::string observed;        ///< as it was reported: "?" if it was not identified
  RobotId identified;          ///< whom it is taken to be of; invalid while that is open
  bool observer_first = true;  ///< the observer stands at a, the observed at b
};

/// Patch b was perhaps taken where patch a lies.
struct Hypothesis {
  HypothesisState state = HypothesisState::open;
  HypothesisSource source = HypothesisSource::lookalike;
  PatchId a, b;                        ///< a < b
  UncertainPose2 T_a_b;                ///< as aligned
  double score = 0;                    ///< share of b's points that lie on a's surfaces
  double ambiguity = 0;                ///< score of the second-best placement over the best one's: 1 = no telling
  double contradicted = 0;             ///< share of b's points that lie deep in what a's surroundings saw as free
  bool foretold = false;               ///< the map itself said it, if less well: it needs no others that agree
  std::vector<std::size_t> supports;   ///< earlier entries that agree with this one, by their place in the ledger
  std::vector<std::size_t> conflicts;  ///< earlier ones that cannot be true together with it
  DecidedBy decided_by = DecidedBy::nobody;
  /// The entry with which it was decided: whose arrival completed the set, or that says the same and that the operator
  /// decided about.
  std::optional<std::size_t> decided_with;
  std::optional<SeenRobot> seen;  ///< of a sighting
  std::string reason;             ///< of the state, in words

  /// Two places of the map that look alike are taken for one.
  [[nodiscard]] bool is_closure() const {
    return state == HypothesisState::accepted && source == HypothesisSource::lookalike;
  }
  /// Nobody has said anything about it yet.
  [[nodiscard]] bool is_undecided() const { return state == HypothesisState::open && !is_withheld(); }
  /// Its places may lie anywhere along some direction: it agrees with whatever does.
  [[nodiscard]] bool has_open_direction() const {
    constexpr double kOpen = 5;  // metres
    return confidence_interval(T_a_b.covariance).position > kOpen;
  }
  /// An operator has said that it is not to be acted on.
  [[nodiscard]] bool is_withheld() const {
    return decided_by == DecidedBy::operator_ && state != HypothesisState::accepted;
  }
};

using Ledger = std::vector<Hypothesis>;

[[nodiscard]] std::size_t count_closures(const Ledger& ledger);

}  // namespace helicoid
