// When agreeing entries of the ledger are enough to be acted on.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "helicoid/mapping/loop_closer.hpp"

namespace helicoid {

bool LoopCloser::is_enough(const std::vector<std::size_t>& agreeing, const Quorum& quorum) const {
  if (!is_quorate(agreeing, quorum)) return false;
  const std::vector<std::size_t> clear = clear_of(agreeing);
  // One may be clear by chance: where little of the other place was seen, its like was not seen either.
  if (clear.size() < std::min(options_.least_clear, quorum.agreeing)) return false;
  // Places from which there is no telling speak for one of many placements: not against those that tell.
  const bool tells = is_quorate(clear, quorum);
  const auto merit = [&](std::size_t i) {
    return tells && ledger_[i].ambiguity >= options_.most_ambiguous ? 0.0 : merit_of(ledger_[i], options_.look_alike);
  };
  double contradicted = 0;
  double together = 0;
  std::set<std::size_t> rivals;
  for (const std::size_t i : agreeing) {
    together += merit_of(ledger_[i], options_.look_alike);
    rivals.insert(ledger_[i].conflicts.begin(), ledger_[i].conflicts.end());
    contradicted += ledger_[i].contradicted / static_cast<double>(agreeing.size());
  }
  double against = 0;
  for (const std::size_t i : rivals) {
    double rival = merit(i);
    for (const std::size_t k : ledger_[i].supports) rival += merit(k);
    against = std::max(against, rival);
  }
  return contradicted <= options_.most_contradicted && together > options_.outvotes * against;
}

std::vector<std::size_t> LoopCloser::clear_of(const std::vector<std::size_t>& entries) const {
  std::vector<std::size_t> clear;
  std::copy_if(entries.begin(), entries.end(), std::back_inserter(clear),
               [&](std::size_t i) { return ledger_[i].ambiguity < options_.most_ambiguous; });
  return clear;
}

bool LoopCloser::is_quorate(const std::vector<std::size_t>& agreeing, const Quorum& quorum) const {
  if (agreeing.empty() || agreeing.size() < quorum.agreeing) return false;
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  for (const std::size_t i : agreeing) {
    low = std::min(low, along_[ledger_[i].b.index()]);
    high = std::max(high, along_[ledger_[i].b.index()]);
  }
  return high - low >= quorum.way;
}

}  // namespace helicoid
