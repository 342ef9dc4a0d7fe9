#include "apps/explanation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "helicoid/fit/confident_pairs.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/manifold/neighbours.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kAbout = 3;           ///< how far about a place its surroundings reach, metres
constexpr double kOnePassage = 30;     ///< what one robot saw within this time is one passage, seconds
constexpr std::size_t kMentioned = 6;  ///< entries that are named one by one

/// "0.41 m away and turned by -3.1 deg".
std::string in_words(const Pose2& T) {
  return fmt::format("{:.2f} m away and turned by {:.1f} deg", T.distance(), degrees(T.yaw));
}
std::string in_words(const ConfidenceInterval& interval) {
  return fmt::format("{:.2f} m and {:.1f} deg", interval.position, degrees(interval.heading));
}

std::string when(const RobotAtStamp& place) {
  return fmt::format("{} at {:.2f} s", place.robot, place.stamp);
}

/// "3, 4, 7 and 12 more".
std::string listed(const std::vector<std::size_t>& ids) {
  const std::size_t shown = std::min(ids.size(), kMentioned);
  std::string text = fmt::format("{}", fmt::join(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (ids.size() > shown) text += fmt::format(" and {} more", ids.size() - shown);
  return text;
}

std::string decided_by(const Hypothesis& h) {
  switch (h.decided_by) {
    case DecidedBy::nobody: return "undecided";
    case DecidedBy::evidence: return "by the evidence";
    case DecidedBy::sighting: return "by a sighting";
    case DecidedBy::operator_: return "by the operator";
  }
  return "";
}

std::string comparison(const Hypothesis& h) {
  std::string text = fmt::format(
      "Of what was seen about the later place {:.0f} % lies on surfaces of the earlier one, and {:.0f} % deep in "
      "what had been seen as free there.",
      100 * h.score, 100 * h.contradicted);
  if (h.ambiguity <= 0) return text + " No other placement came near.";
  const char* verdict = h.ambiguity < 0.75  ? "it is clear which is right, if one is"
                        : h.ambiguity < 0.9 ? "fairly clear, not beyond doubt"
                                            : "from this place alone there is no telling";
  return text + fmt::format(" The second-best placement fits {:.0f} % as well: {}.", 100 * h.ambiguity, verdict);
}

/// Relations that tie what lies about one patch to what lies about the other, one passage of a robot left out.
std::size_t ties_between(const Map& map, PatchId a, PatchId b) {
  const auto about = [&](PatchId p, PatchId centre) {
    return (map.T_plane_patch(p).translation() - map.T_plane_patch(centre).translation()).norm() <= kAbout;
  };
  const auto passage = [&](PatchId p, PatchId q) {
    return map.patch(p).robot == map.patch(q).robot && std::abs(map.patch(p).stamp - map.patch(q).stamp) < kOnePassage;
  };
  const auto belongs = [&](PatchId p, PatchId centre) { return about(p, centre) && passage(p, centre); };
  return static_cast<std::size_t>(std::count_if(map.relations().begin(), map.relations().end(), [&](const Relation& r) {
    return (belongs(r.a, a) && belongs(r.b, b)) || (belongs(r.a, b) && belongs(r.b, a));
  }));
}

/// How well b is known relative to a, midway between them, by these of an island's relations; nothing if they do not
/// tie the two together.
std::optional<ConfidenceInterval> known_by(const Map& map, const Island& island, PatchId a, PatchId b,
                                           const std::vector<GraphEdge>& edges) {
  std::vector<std::vector<std::uint32_t>> tied(island.patches.size());
  for (const GraphEdge& e : edges) {
    tied[e.a].push_back(e.b);
    tied[e.b].push_back(e.a);
  }
  // What can be reached from a, numbered in that order.
  constexpr std::uint32_t kNowhere = ~std::uint32_t{0};
  std::vector<std::uint32_t> reached{island.place_of(a)};
  std::vector<std::uint32_t> number(island.patches.size(), kNowhere);
  number[reached[0]] = 0;
  std::vector<Pose2> poses;
  for (std::size_t at = 0; at < reached.size(); ++at) {
    poses.push_back(map.T_plane_patch(island.patches[reached[at]]));
    for (const std::uint32_t next : tied[reached[at]]) {
      if (number[next] != kNowhere) continue;
      number[next] = static_cast<std::uint32_t>(reached.size());
      reached.push_back(next);
    }
  }
  const std::uint32_t place_of_b = number[island.place_of(b)];
  if (place_of_b == kNowhere) return std::nullopt;
  std::vector<GraphEdge> reachable;
  for (GraphEdge e : edges) {
    if (number[e.a] == kNowhere) continue;
    e.a = number[e.a];
    e.b = number[e.b];
    reachable.push_back(e);
  }
  const RelativeCovariance covariance(poses, reachable);
  if (!covariance.is_determined()) return std::nullopt;
  return midway_interval(covariance.of(0, place_of_b));
}

/// An island's relations without those by which a robot came back or met another.
std::vector<GraphEdge> edges_of_single_ways(const Map& map, const Island& island) {
  std::vector<PatchId> last(map.robots().size());
  std::vector<std::uint32_t> rank(map.patch_count());
  for (const PatchId id : island.patches) {
    PatchId& before = last[map.patch(id).robot.index()];
    rank[id.index()] = before.valid() ? rank[before.index()] + 1 : 0;
    before = id;
  }
  std::vector<GraphEdge> edges = graph_edges(map, island);
  std::erase_if(edges, [&](const GraphEdge& e) {
    const PatchId a = island.patches[e.a];
    const PatchId b = island.patches[e.b];
    return map.patch(a).robot != map.patch(b).robot || rank[b.index()] != rank[a.index()] + 1;
  });
  return edges;
}

/// Entries that speak of these two surroundings, whichever way round.
std::vector<std::size_t> entries_about(const Map& map, const std::vector<RecordedEntry>& ledger, PatchId a, PatchId b) {
  const auto near = [&](PatchId p, PatchId q) {
    return map.island_of(p) == map.island_of(q) &&
           (map.T_plane_patch(p).translation() - map.T_plane_patch(q).translation()).norm() <= kAbout;
  };
  std::vector<std::size_t> about;
  for (std::size_t i = 0; i < ledger.size(); ++i) {
    const Hypothesis& h = ledger[i].hypothesis;
    if ((near(h.a, a) && near(h.b, b)) || (near(h.a, b) && near(h.b, a))) about.push_back(i);
  }
  return about;
}

std::string said_by_ledger(const std::vector<RecordedEntry>& ledger, const std::vector<std::size_t>& about) {
  if (about.empty()) return "No entry of the ledger speaks of these two places.";
  std::string text = "The ledger has of these places:";
  for (std::size_t k = 0; k < std::min(about.size(), kMentioned); ++k) {
    const Hypothesis& h = ledger[about[k]].hypothesis;
    text += fmt::format("\n  entry {} ({}, {}): {}", about[k], name_of(h.state), decided_by(h), h.reason);
  }
  if (about.size() > kMentioned) text += fmt::format("\n  and {} more", about.size() - kMentioned);
  return text;
}

std::string place_in_words(const Map& map, const AskedPlace& place) {
  const Patch& patch = map.patch(place.patch);
  const Pose2 T = map.T_plane_patch(place.patch) * place.T_patch_place;
  return fmt::format("{} is ({:.2f}, {:.2f}) on island {}, on a patch that {} made at {:.2f} s", place.name, T.x, T.y,
                     map.island_of(place.patch).value, map.robot(patch.robot).name, patch.stamp);
}

const char* sheet_in_words(const Map& map, PatchId a, PatchId b) {
  if (a == b) return "They stand on one patch.";
  const Neighbours all = find_neighbours(map, {1e9, 1e9});
  const auto has = [&](const Neighbours& n) { return std::binary_search(n[a.index()].begin(), n[a.index()].end(), b); };
  if (!has(all)) return "Their patches do not overlap.";
  return has(find_neighbours(map)) ? "Their patches overlap and are neighbours: one sheet."
                                   : "Their patches overlap in the plane, but that is not known well enough to be "
                                     "believed: as far as the map "
                                     "knows they may be different places, one sheet over the other.";
}

std::string advice(const Hypothesis& h, std::size_t id) {
  if (h.decided_by == DecidedBy::operator_)
    return fmt::format("To take your word back: helicoid ledger MAP undo {} --out DIR", id);
  if (h.state == HypothesisState::accepted) {
    return fmt::format("If it is wrong: helicoid ledger MAP reject {} --out DIR (undo leaves it open)", id);
  }
  return fmt::format("If you know better: helicoid ledger MAP accept {} --out DIR, or reject", id);
}

std::string agreement(const std::vector<std::size_t>& supports, const std::vector<std::size_t>& conflicts) {
  std::string text = supports.empty()
                         ? "No other entry agrees with it."
                         : fmt::format("For it: entries {} come to the same around the loop.", listed(supports));
  if (!conflicts.empty())
    text += fmt::format(" Against it: entries {} cannot be true together with it.", listed(conflicts));
  return text;
}

}  // namespace

Explanation explain_entry(const Map& map, const std::vector<RecordedEntry>& ledger, std::size_t id) {
  const RecordedEntry& entry = ledger[id];
  const Hypothesis& h = entry.hypothesis;
  std::vector<std::size_t> supports = h.supports;
  std::vector<std::size_t> conflicts = h.conflicts;
  for (std::size_t i = id + 1; i < ledger.size(); ++i) {
    const auto speaks = [&](const std::vector<std::size_t>& of) {
      return std::find(of.begin(), of.end(), id) != of.end();
    };
    if (speaks(ledger[i].hypothesis.supports)) supports.push_back(i);
    if (speaks(ledger[i].hypothesis.conflicts)) conflicts.push_back(i);
  }
  const ConfidenceInterval stated = confidence_interval(h.T_a_b.covariance);
  const bool together = map.island_of(h.a) == map.island_of(h.b);
  const Pose2 T_map = map.T_plane_patch(h.a).inverse() * map.T_plane_patch(h.b);
  const Pose2 off = h.T_a_b.T_a_b.inverse() * T_map;
  const std::size_t ties = ties_between(map, h.a, h.b);
  Explanation e;
  e.paragraphs.push_back(fmt::format("Entry {} says that {} was where {} was. It is {}, {}: {}.", id, when(entry.b),
                                     when(entry.a), name_of(h.state), decided_by(h), h.reason));
  if (h.source == HypothesisSource::lookalike) e.paragraphs.push_back(comparison(h));
  std::string where = fmt::format("By it the second place lies {} from the first, give or take {} (95 %).",
                                  in_words(h.T_a_b.T_a_b), in_words(stated));
  where += together ? fmt::format(" The map has it {}: {:.2f} m and {:.1f} deg from what the entry says.",
                                  in_words(T_map), off.distance(), std::abs(degrees(off.yaw)))
                    : " The map has the two on different islands and does not know how they lie.";
  where += ties > 0 ? fmt::format(" {} relations tie the one passage to the other.", ties)
                    : " No relation ties the one passage to the other.";
  e.paragraphs.push_back(where);
  e.paragraphs.push_back(agreement(supports, conflicts));
  e.paragraphs.push_back(advice(h, id));
  e.figures = {{"entry", id},
               {"state", name_of(h.state)},
               {"supports", supports},
               {"conflicts", conflicts},
               {"same_island", together},
               {"ties", ties}};
  e.figures["off_m"] = together ? Json(off.distance()) : Json();
  e.figures["off_deg"] = together ? Json(std::abs(degrees(off.yaw))) : Json();
  return e;
}

Explanation explain_places(const Map& map, const std::vector<RecordedEntry>& ledger, const AskedPlace& a,
                           const AskedPlace& b) {
  Explanation e;
  e.paragraphs.push_back(place_in_words(map, a) + ".\n" + place_in_words(map, b) + ".");
  const bool together = map.island_of(a.patch) == map.island_of(b.patch);
  const std::vector<std::size_t> about = entries_about(map, ledger, a.patch, b.patch);
  e.figures = {{"same_island", together}, {"entries", about}};
  e.figures["distance_m"] = e.figures["known_m"] = e.figures["known_deg"] = Json();
  e.figures["single_way_m"] = Json();
  if (!together) {
    e.paragraphs.emplace_back(
        "They are on different islands: the map does not know how they lie. A sighting, an operator or --join evidence "
        "would join them.");
  } else {
    const Island island = map.island_with(a.patch);
    const Pose2 T_a_b =
        a.T_patch_place.inverse() * map.T_plane_patch(a.patch).inverse() * map.T_plane_patch(b.patch) * b.T_patch_place;
    const auto known = known_by(map, island, a.patch, b.patch, graph_edges(map, island));
    const auto single = known_by(map, island, a.patch, b.patch, edges_of_single_ways(map, island));
    std::string text = fmt::format("{} lies {} as seen from {}, ", b.name, in_words(T_a_b), a.name);
    text += known ? fmt::format("known to {} (95 %).", in_words(*known)) : "but how well that is known is open.";
    text += single ? fmt::format(" By the robot's way alone, without coming back or meeting, it would be known to {}.",
                                 in_words(*single))
                   : " Only by closures or sightings are they tied together at all.";
    e.paragraphs.push_back(text + " " + sheet_in_words(map, a.patch, b.patch));
    e.figures["distance_m"] = T_a_b.distance();
    if (known) e.figures["known_m"] = known->position;
    if (known) e.figures["known_deg"] = degrees(known->heading);
    if (single) e.figures["single_way_m"] = single->position;
  }
  e.paragraphs.push_back(said_by_ledger(ledger, about));
  return e;
}

}  // namespace helicoid
