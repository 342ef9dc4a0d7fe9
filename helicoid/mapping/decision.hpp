// What an operator has decided about entries of the ledger (design 5.6). Given from the start of a run: undo, reject
// and accept are one mechanism, a replay with other decisions.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/manifold/map.hpp"
#include "helicoid/mapping/ledger.hpp"

namespace helicoid {

/// Where a robot was at a time. Unlike an entry's number it means the same in every replay.
struct RobotAtStamp {
  std::string robot;
  double stamp = 0;  ///< seconds, of the robot's own clock; equal within 5 microseconds
};

/// The state of the entry that says that b was where a was. `open`: the operator leaves it open, whatever agrees.
struct Decision {
  HypothesisState state = HypothesisState::open;
  HypothesisSource source = HypothesisSource::lookalike;
  RobotAtStamp a, b;
  std::size_t act = 0;                  ///< decisions of one act are taken back together; 0: it stands alone
  DecidedBy by = DecidedBy::operator_;  ///< the evidence of an earlier pass, else
  std::string reason{};                 ///< in words; may be empty
};

/// The places that an entry speaks of, as a decision names them: an unidentified robot is "?".
[[nodiscard]] RobotAtStamp first_place(const Map& map, const Hypothesis& h);
[[nodiscard]] RobotAtStamp second_place(const Map& map, const Hypothesis& h);

/// True if a decision is about the entry of this source and these places, whichever is named first.
[[nodiscard]] bool is_about(const Decision& decision, HypothesisSource source, const RobotAtStamp& a,
                            const RobotAtStamp& b);

/// The decision about an entry, whichever of its places is named first; nullptr: there is none. The last one counts.
[[nodiscard]] const Decision* find_decision(std::span<const Decision> decisions, const Map& map, const Hypothesis& h);

}  // namespace helicoid
