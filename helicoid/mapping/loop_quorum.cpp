// When agreeing entries of the ledger are enough to be acted on.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

#include "helicoid/manifold/stated_confidence.hpp"
#include "helicoid/mapping/loop_closer.hpp"

namespace helicoid {

bool LoopCloser::is_sound(std::size_t entry) const {
  const Hypothesis& h = ledger_[entry];
  return !is_left_open(h) && h.contradicted <= options_.most_contradicted_one;
}

std::vector<std::size_t> LoopCloser::true_together_with(std::size_t entry) const {
  const auto conflict = [&](std::size_t i, std::size_t k) {
    const std::vector<std::size_t>& earlier = ledger_[std::max(i, k)].conflicts;
    return std::find(earlier.begin(), earlier.end(), std::min(i, k)) != earlier.end();
  };
  // A sighting that was believed at once may be a lie: it is held to account, and does not bind others.
  const auto is_believed = [&](std::size_t i) { return ledger_[i].is_closure(); };
  std::vector<std::size_t> ranked = ledger_[entry].supports;
  std::erase_if(ranked, [&](std::size_t i) { return !is_sound(i); });
  std::stable_sort(ranked.begin(), ranked.end(), [&](std::size_t i, std::size_t k) {
    if (is_believed(i) != is_believed(k)) return is_believed(i);
    return merit_of(ledger_[i], options_.look_alike) > merit_of(ledger_[k], options_.look_alike);
  });
  const std::vector<std::size_t>& against = ledger_[entry].conflicts;
  if (!is_sound(entry) || std::any_of(against.begin(), against.end(), is_believed)) return {};
  std::vector<std::size_t> together;
  for (const std::size_t i : ranked) {
    if (std::none_of(together.begin(), together.end(), [&](std::size_t k) { return conflict(i, k); })) {
      together.push_back(i);
    }
  }
  std::sort(together.begin(), together.end());
  together.push_back(entry);
  return together;
}

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

bool LoopCloser::leave_what_map_rules_out(const Map& map, const std::vector<std::size_t>& agreeing) {
  const double inflation = options_.look_alike.drift_inflation;
  std::optional<StatedConfidence> exact;
  bool any = false;
  for (const std::size_t i : agreeing) {
    Hypothesis& h = ledger_[i];
    if (h.state != HypothesisState::open || map.island_of(h.a) != map.island_of(h.b)) continue;
    const Pose2 T_a_b = map.T_plane_patch(h.a).inverse() * map.T_plane_patch(h.b);
    const double apart = (T_a_b.translation() - h.T_a_b.T_a_b.translation()).norm();
    if (apart < options_.ruled_out_from) continue;
    if (!exact) exact.emplace(map, map.island_with(h.a));
    if (!exact->is_determined()) return false;
    UncertainPose2 said = exact->between(h.a, h.b);
    said.covariance *= inflation * inflation;
    if (disagreement(said, h.T_a_b) < options_.ruled_out) continue;
    h.decided_by = DecidedBy::evidence;
    h.reason =
        fmt::format("agrees with others, but lies {:.1f} m from where the map has it, which knows it to {:.1f} m",
                    apart, confidence_interval(said.covariance).position);
    any = true;
  }
  return any;
}

std::vector<std::size_t> LoopCloser::clear_of(const std::vector<std::size_t>& entries) const {
  std::vector<std::size_t> clear;
  std::copy_if(entries.begin(), entries.end(), std::back_inserter(clear),
               [&](std::size_t i) { return ledger_[i].ambiguity < options_.most_ambiguous; });
  return clear;
}

bool LoopCloser::is_quorate(const std::vector<std::size_t>& entries, const Quorum& quorum) const {
  // Who leaves a direction open agrees with any place along it.
  std::vector<std::size_t> agreeing = entries;
  std::erase_if(agreeing, [&](std::size_t i) { return ledger_[i].has_open_direction(); });
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
