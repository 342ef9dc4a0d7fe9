// What tells a place from others that look like it, in words.
#pragma once

#include <map>

#include "helicoid/mapping/ledger.hpp"
#include "helicoid/mapping/two_places.hpp"

namespace helicoid {

/// One way in which two places may lie, and the share of what was seen that speaks against it.
struct JudgedPlacement {
  Pose2 T_a_b;
  double contradicted = 0;
};

/// By what the second-best placement is ruled out, if that is something that stands there; else empty.
[[nodiscard]] std::string difference_in_words(const Map& map, const TwoPlaces& places, const JudgedPlacement& best,
                                              const JudgedPlacement& second);

/// To be added to the reason of entries that are accepted together after doubt: which of them told the place from those
/// that look alike, and by what: `told_apart`, by entry. Empty if there was no doubt or nothing stands out.
/// `most_ambiguous`: of an entry that can tell.
[[nodiscard]] std::string what_tells(const Ledger& ledger, const std::map<std::size_t, std::string>& told_apart,
                                     std::span<const std::size_t> agreeing, double most_ambiguous);

}  // namespace helicoid
