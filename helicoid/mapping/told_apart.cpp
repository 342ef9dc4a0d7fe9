#include "helicoid/mapping/told_apart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace helicoid {

std::string difference_in_words(const Map& map, const TwoPlaces& places, const JudgedPlacement& best,
                                const JudgedPlacement& second) {
  constexpr double kStandsOut = 0.01;
  if (second.contradicted < best.contradicted + kStandsOut) return "";
  const Pose2 apart = best.T_a_b.inverse() * second.T_a_b;
  const Vector2d p = middle_of_contradiction(map, places, second.T_a_b);
  return fmt::format(
      "a placement {:.1f} m aside is ruled out by what stands about {:.1f} m away, {:.0f} deg to the {}: {:.0f} % of "
      "what is seen speaks against it",
      apart.distance(), p.norm(), std::abs(degrees(std::atan2(p.y(), p.x()))), p.y() >= 0 ? "left" : "right",
      100 * second.contradicted);
}

std::string what_tells(const Ledger& ledger, const std::map<std::size_t, std::string>& told_apart,
                       std::span<const std::size_t> agreeing, double most_ambiguous) {
  const auto is_clear = [&](std::size_t i) { return ledger[i].ambiguity < most_ambiguous; };
  const bool was_in_doubt = std::any_of(agreeing.begin(), agreeing.end(),
                                        [&](std::size_t i) { return !is_clear(i) || !ledger[i].conflicts.empty(); });
  if (!was_in_doubt) return "";
  for (auto i = agreeing.rbegin(); i != agreeing.rend(); ++i) {
    const auto words = told_apart.find(*i);
    if (words == told_apart.end() || words->second.empty() || !is_clear(*i)) continue;
    return fmt::format("; entry {} tells it from places that look alike: {}", *i, words->second);
  }
  return "";
}

}  // namespace helicoid
