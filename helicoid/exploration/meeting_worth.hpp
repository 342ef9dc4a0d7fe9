// Whether a rendezvous is worth its time (paper VI): what it would save, by how likely its places are one, beside what
// its two robots could drive meanwhile.
#pragma once

#include <span>

#include "helicoid/exploration/frontiers.hpp"
#include "helicoid/exploration/known_floor.hpp"
#include "helicoid/exploration/rendezvous.hpp"

namespace helicoid {

struct MeetingWorthOptions {
  double doubt_reach = 10;     ///< frontiers so near to a doubt's places may show what is known already, metres
  double metres_per_m2 = 0.8;  ///< what robots drive for a square metre in the end: 0.7 to 0.9 in rooms and corridors
  double standing_m = 6;       ///< that either robot could drive while it stands there and looks, metres
};

/// What meetings have said so far.
struct MeetingRecord {
  int met = 0;
  int absent = 0;
};

/// The probability that a doubt's two places are one (Bayes). Of the places where the other island may lie one is right
/// at most, and with some probability none: the more of them meetings have ruled out, the likelier is each that is
/// left, but the likelier, too, that none is. Open doubts that would join two islands alike are one place; a rival
/// placement that fits as well is one more, unless it is among them or was ruled out.
[[nodiscard]] double likelihood_of(const Map& map, const Doubt& doubt, std::span<const Doubt> open,
                                   const RendezvousDesk& desk, const MeetingRecord& record);

/// What the team has to look at. `way` by member and frontier, metres.
struct TeamAtWork {
  std::span<const Frontier> frontiers;
  const Eigen::MatrixXd& way;
};

/// By expected gain. If the places are one, what is known beyond one of them need not be looked at again from the
/// other's side, and what is open on both only once. What neither side is at is no reason to meet: whoever gets there
/// first sees something new. Where nothing is left to look at, every meeting is worth its time.
[[nodiscard]] bool is_worth_meeting(const Map& map, const Doubt& doubt, double likelihood, const Pairing& pair,
                                    const TeamAtWork& team, KnownFloor& floor, const MeetingWorthOptions& options = {});

}  // namespace helicoid
