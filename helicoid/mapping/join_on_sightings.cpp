#include "helicoid/mapping/join_on_sightings.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>

#include "helicoid/mapping/sighting_consensus.hpp"
#include "helicoid/mapping/sighting_fit.hpp"

namespace helicoid {

namespace {

bool is_open(const LoopCloser& closer, const SightingRecord& record) {
  return closer.ledger()[record.entry].is_undecided();
}

IslandId island_of(const Map& map, const ManifoldPose& pose) {
  return map.island_of(pose.patch);
}

bool is_ordered(const LoopCloser& closer, const SightingRecord& record) {
  return is_ordered(closer.ledger()[record.entry]);
}

/// Of what is open between two islands so many of the newest are thought of together. Robots that stare at one another
/// for minutes say the same again and again, and each sighting is held against each.
constexpr std::size_t kMostOptions = 48;

/// What is open between two islands, as far as the scans have not contradicted it; what an operator accepted in any
/// case.
std::vector<SightingOption> options_between(const Map& map, const LoopCloser& closer, const SightingLog& log,
                                            IslandId x, IslandId y) {
  std::vector<SightingOption> options;
  for (const std::size_t i : log.in_question()) {
    const SightingRecord& record = log.placed()[i];
    if (!is_usable(record.sighting)) continue;
    const bool ordered = is_ordered(closer, record);
    if (!is_open(closer, record) && !ordered) continue;
    for (std::size_t k = 0; k < record.candidates.size(); ++k) {
      const SeenCandidate& c = record.candidates[k];
      const IslandId a = island_of(map, record.observer_at.pose);
      const IslandId b = island_of(map, c.at.pose);
      if ((c.ground.verdict == Verdict::contradicted && !ordered) || !((a == x && b == y) || (a == y && b == x)))
        continue;
      options.push_back({i, k, {record.observer_at.pose, c.at.pose, record.sighting}, record.candidates.size() == 1});
    }
  }
  std::size_t excess = options.size() - std::min(options.size(), kMostOptions);
  std::erase_if(options, [&](const SightingOption& o) {
    const bool goes = excess > 0 && !is_ordered(closer, log.placed()[o.record]);
    excess -= goes ? 1 : 0;
    return goes;
  });
  return options;
}

/// Two scans agree by chance to this share now and then; one nameless sighting alone must do better.
constexpr double kBeyondChance = 0.75;
/// Share of the points that agree.
constexpr double kHardlyContradicted = 0.9;

/// True if the scans tell that it is this candidate and no other.
bool is_told_apart(const SightingRecord& record, std::size_t candidate) {
  for (std::size_t k = 0; k < record.candidates.size(); ++k) {
    const Verdict verdict = record.candidates[k].ground.verdict;
    if ((verdict == Verdict::confirmed) != (k == candidate)) return false;
  }
  return true;
}

/// Of sightings that name nobody: the scans tell whom two are of that agree, or whom one is of beyond chance.
bool is_told_apart(const SightingLog& log, const SightingConsensus& consensus) {
  std::size_t told = 0;
  double best = 0;
  for (const SightingOption& o : consensus.members) {
    const SightingRecord& record = log.placed()[o.record];
    if (!is_told_apart(record, o.candidate)) continue;
    ++told;
    best = std::max(best, record.candidates[o.candidate].ground.share());
  }
  return told > 1 || best >= kBeyondChance;
}

/// What the scans say of a join as a whole, where the robots of its newest sighting stood.
SharedGround ground_of(const Map& map, const InformationGraph& graph, const SightingConsensus& consensus) {
  const IslandJoin& join = consensus.join;
  const PlacedSighting& newest = consensus.members.back().placed;
  const bool forward = map.island_of(newest.observer.patch) == map.island_of(join.a);
  const UncertainPose2 T_a_b{join.T_a_b, join.information.inverse()};
  const auto from = [&](PatchId patch, const ManifoldPose& robot) {
    return UncertainPose2{map.T_plane_patch(patch).inverse() * map.project(robot), Matrix3d::Zero()};
  };
  const UncertainPose2 T_observer_near = invert(from(forward ? join.a : join.b, newest.observer));
  const UncertainPose2 T_far_observed = from(forward ? join.b : join.a, newest.observed);
  const UncertainPose2 T = compound(compound(T_observer_near, forward ? T_a_b : invert(T_a_b)), T_far_observed);
  return compare_ground(map, graph, {newest.observer, {}}, {newest.observed, {}}, T);
}

bool may_join(const Map& map, const InformationGraph& graph, const LoopCloser& closer, const SightingLog& log,
              const SightingConsensus& consensus, std::size_t options, bool last) {
  const bool ordered = std::any_of(consensus.members.begin(), consensus.members.end(),
                                   [&](const SightingOption& o) { return is_ordered(closer, log.placed()[o.record]); });
  if (ordered) return true;
  const auto identified = std::count_if(consensus.members.begin(), consensus.members.end(),
                                        [](const SightingOption& o) { return o.identified; });
  if (identified == 0 && !is_told_apart(log, consensus)) return false;
  const SharedGround ground = ground_of(map, graph, consensus);
  if (ground.verdict == Verdict::confirmed) return true;
  if (ground.verdict == Verdict::contradicted) return false;
  // Little was said, but hardly anything against it: an identified sighting is acted on at once.
  if (identified > 0 && ground.share() >= kHardlyContradicted) return true;
  // One robot's word and nobody's against it; or more of one mind than not.
  return last && identified > 0 && 2 * consensus.members.size() > options;
}

/// A pair of islands that open sightings may be of, by the newest sighting.
std::vector<std::pair<IslandId, IslandId>> pairs_in_question(const Map& map, const LoopCloser& closer,
                                                             const SightingLog& log) {
  std::vector<std::pair<IslandId, IslandId>> pairs;
  for (std::size_t n = log.in_question().size(); n-- > 0;) {
    const SightingRecord& record = log.placed()[log.in_question()[n]];
    if (!is_open(closer, record) && !is_ordered(closer, record)) continue;
    for (const SeenCandidate& c : record.candidates) {
      const IslandId x = island_of(map, record.observer_at.pose);
      const IslandId y = island_of(map, c.at.pose);
      const std::pair pair(std::min(x, y), std::max(x, y));
      if (x != y && std::count(pairs.begin(), pairs.end(), pair) == 0) pairs.push_back(pair);
    }
  }
  return pairs;
}

void accept_members(LoopCloser& closer, const SightingLog& log, const SightingConsensus& consensus) {
  for (const SightingOption& o : consensus.members) {
    const SightingRecord& record = log.placed()[o.record];
    if (closer.ledger()[record.entry].state == HypothesisState::accepted) continue;
    Hypothesis h = entry_of(record, record.candidates[o.candidate]);
    h.state = HypothesisState::accepted;
    h.decided_by = DecidedBy::sighting;
    h.decided_with = log.placed()[consensus.members.back().record].entry;
    h.reason = fmt::format("{} measurements of {} sightings determine how two islands lie, chi^2 {:.1f}",
                           consensus.join.measurements, consensus.members.size(), consensus.join.chi2);
    closer.revise(record.entry, std::move(h));
  }
}

/// The newest pair of islands that may be joined now, and how.
std::optional<SightingConsensus> find_join(const MapInProgress& progress, const LoopCloser& closer,
                                           const SightingLog& log, bool last) {
  for (const auto& [x, y] : pairs_in_question(progress.map, closer, log)) {
    const std::vector<SightingOption> between = options_between(progress.map, closer, log, x, y);
    for (SightingConsensus& consensus : find_consensuses(progress.map, progress.graph, between)) {
      if (may_join(progress.map, progress.graph, closer, log, consensus, between.size(), last))
        return std::move(consensus);
    }
  }
  return std::nullopt;
}

}  // namespace

bool join_on_sightings(MapInProgress& progress, LoopCloser& closer, const SightingLog& log, bool last,
                       const MapperOptions& options) {
  bool joined = false;
  while (const std::optional<SightingConsensus> consensus = find_join(progress, closer, log, last)) {
    accept_members(closer, log, *consensus);
    join_islands(progress, closer, consensus->join, options);
    joined = true;
  }
  return joined;
}

}  // namespace helicoid
