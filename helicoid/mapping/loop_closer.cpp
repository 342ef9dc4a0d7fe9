#include "helicoid/mapping/loop_closer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/told_apart.hpp"

namespace helicoid {

namespace {

/// Entries are compared if their first places are known this well to one another (eq. 10), metres and radians,
constexpr double kKnown = 0.6;
constexpr double kKnownHeading = 0.25;
/// and lie no farther apart than this, metres.
constexpr double kPassage = 30;

constexpr const char* kWaits = "waits for others that agree";

const BoundedPose* find(std::span<const BoundedPose> poses, PatchId id) {
  const auto at = std::find_if(poses.begin(), poses.end(), [&](const BoundedPose& p) { return p.pose == id.value; });
  return at == poses.end() ? nullptr : &*at;
}

BoundOptions passage_about(const Map& map, PatchId id) {
  return bound_options(map.patch(id), kKnown, kKnownHeading, kPassage);
}

}  // namespace

void LoopCloser::follow_ways(const Map& map) {
  while (along_.size() < map.patch_count()) {
    const PatchId b = make_id<PatchId>(along_.size());
    const std::size_t robot = map.patch(b).robot.index();
    if (last_of_robot_.size() <= robot) {
      last_of_robot_.resize(robot + 1);
      searched_at_.resize(robot + 1, 0);
    }
    const PatchId last = last_of_robot_[robot];
    const Pose2 step = last.valid() ? map.T_plane_patch(last).inverse() * map.T_plane_patch(b) : Pose2{};
    along_.push_back(last.valid() ? along_[last.index()] + step.distance() : 0);
    last_of_robot_[robot] = b;
  }
}

void LoopCloser::start_again(const Map& map) {
  follow_ways(map);
  std::fill(searched_at_.begin(), searched_at_.end(), -HUGE_VAL);
}

double LoopCloser::way_since_search(const Map& map, PatchId b) const {
  return along_[b.index()] - searched_at_[map.patch(b).robot.index()];
}

bool LoopCloser::is_due_again(const Map& map, PatchId b) const {
  return way_since_search(map, b) >= options_.spacing_again;
}

std::vector<std::size_t> LoopCloser::observe(const Map& map, const InformationGraph& graph, PatchId b,
                                             const LocalMap& known) {
  follow_ways(map);
  if (way_since_search(map, b) < options_.search_spacing) return {};
  return look_about(map, graph, b, known, options_.look_alike);
}

std::vector<std::size_t> LoopCloser::observe_again(const Map& map, const InformationGraph& graph, PatchId b,
                                                   const LocalMap& known) {
  LookAlikeOptions nearest = options_.look_alike;
  nearest.candidates = options_.candidates_again;
  nearest.narrow_reach = options_.reach_again;
  return look_about(map, graph, b, known, nearest);
}

std::vector<std::size_t> LoopCloser::look_about(const Map& map, const InformationGraph& graph, PatchId b,
                                                const LocalMap& known, const LookAlikeOptions& options) {
  searched_at_[map.patch(b).robot.index()] = along_[b.index()];
  const std::vector<PatchId> possible = possible_candidates(map, b, known, options);
  if (possible.empty()) return {};
  const std::vector<std::uint32_t> sought = poses_in_question(map, b, possible, options);
  BoundOptions everything = bound_options(map.patch(b), 1e3, 1e3, 1e9);
  everything.most = map.patch_count();
  everything.sought = sought;
  const std::vector<BoundedPose> about_b = tree_bound(graph, map.poses(), b.value, everything);
  const std::vector<Candidate> candidates = find_candidates(map, graph, b, about_b, known, options);
  if (candidates.empty()) return {};
  const PlaceBefore place = see_place(map, b, options);
  std::vector<Hypothesis> found;
  for (const Candidate& candidate : candidates) {
    if (std::optional<Hypothesis> h = compare_places(map, graph, candidate, place, mapper_, options)) {
      found.push_back(std::move(*h));
    }
  }
  compare_with_one_another(map, graph, found);
  std::vector<std::size_t> accepted;
  for (Hypothesis& h : found) {
    told_apart_[ledger_.size()] = std::exchange(h.reason, kWaits);
    const Quorum quorum = h.foretold ? kForetold : Quorum{options_.least_agreeing, options_.least_way};
    const std::vector<std::size_t> now = enter(map, graph, about_b, std::move(h), quorum);
    accepted.insert(accepted.end(), now.begin(), now.end());
  }
  return accepted;
}

std::vector<std::uint32_t> LoopCloser::poses_in_question(const Map& map, PatchId b, std::span<const PatchId> possible,
                                                         const LookAlikeOptions& options) const {
  std::vector<std::uint32_t> poses;
  poses.reserve(possible.size());
  for (const PatchId a : possible) poses.push_back(a.value);
  const Vector2d p_b = map.T_plane_patch(b).translation();
  const double reach = farthest_candidate(options) + kPassage;
  const std::size_t first = ledger_.size() > options_.memory ? ledger_.size() - options_.memory : 0;
  for (std::size_t i = 0; i < ledger_.size(); ++i) {
    const Hypothesis& h = ledger_[i];
    if (i < first && !h.is_withheld()) continue;
    const bool is_near = (map.T_plane_patch(h.a).translation() - p_b).norm() <= reach;
    if (is_near && map.island_of(h.b) == map.island_of(b)) poses.push_back(h.b.value);
  }
  return poses;
}

void LoopCloser::compare_with_one_another(const Map& map, const InformationGraph& graph,
                                          std::vector<Hypothesis>& found) const {
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::vector<BoundedPose> about_a =
        tree_bound(graph, map.poses(), found[i].a.value, passage_about(map, found[i].a));
    for (std::size_t k = 0; k < i; ++k) {
      // Where the map itself does not know how the two places lie, both may be right.
      const BoundedPose* other = find(about_a, found[k].a);
      if (other == nullptr) continue;
      const UncertainPose2 around = compound(other->relative, found[k].T_a_b);
      if (disagreement(around, found[i].T_a_b) < options_.consistent) continue;
      const double ratio = merit_of(found[i], options_.look_alike) / merit_of(found[k], options_.look_alike);
      found[k].ambiguity = std::max(found[k].ambiguity, std::min(1.0, ratio));
      found[i].ambiguity = std::max(found[i].ambiguity, std::min(1.0, 1 / ratio));
    }
  }
}

std::vector<std::size_t> LoopCloser::enter(const Map& map, const InformationGraph& graph,
                                           std::span<const BoundedPose> about_b, Hypothesis found,
                                           const Quorum& quorum) {
  const std::size_t entry = ledger_.size();
  ledger_.push_back(std::move(found));
  compare_with_earlier(map, graph, about_b, entry);
  const Hypothesis& h = ledger_[entry];
  if (follow_operator(map, entry)) {
    return h.state == HypothesisState::accepted ? std::vector{entry} : std::vector<std::size_t>{};
  }
  const std::vector<std::size_t> agreeing = true_together_with(entry);
  if (!is_enough(agreeing, quorum) || leave_what_map_rules_out(map, agreeing)) return {};
  return accept(agreeing);
}

bool LoopCloser::follow_operator(const Map& map, std::size_t entry) {
  Hypothesis& h = ledger_[entry];
  if (const Decision* decision = find_decision(mapper_.decisions, map, h)) {
    h.state = decision->state;
    h.decided_by = DecidedBy::operator_;
    h.reason = h.state == HypothesisState::open ? "left open"
               : decision->reason.empty()       ? "decided without looking at others"
                                                : decision->reason;
  } else {
    const auto withheld =
        std::find_if(h.supports.begin(), h.supports.end(), [&](std::size_t i) { return ledger_[i].is_withheld(); });
    if (withheld == h.supports.end()) return false;
    withhold_with(entry, *withheld);
  }
  if (!h.is_withheld()) return true;
  for (const std::size_t i : h.supports) {
    if (ledger_[i].is_undecided()) withhold_with(i, entry);
  }
  return true;
}

std::vector<std::size_t> LoopCloser::decide(const Map& map, const Decision& decision) {
  mapper_.decisions.push_back(decision);
  std::vector<std::size_t> accepted;
  for (std::size_t i = 0; i < ledger_.size(); ++i) {
    const Hypothesis& h = ledger_[i];
    if (!h.is_undecided() || !is_about(decision, h.source, first_place(map, h), second_place(map, h))) continue;
    follow_operator(map, i);
    if (h.state == HypothesisState::accepted) accepted.push_back(i);
  }
  return accepted;
}

void LoopCloser::withhold_with(std::size_t entry, std::size_t decided) {
  const Hypothesis& other = ledger_[decided];
  Hypothesis& h = ledger_[entry];
  h.state = other.state;
  h.decided_by = DecidedBy::operator_;
  h.decided_with = other.decided_with.value_or(decided);
  h.reason = fmt::format("says the same as entry {}, which was decided", *h.decided_with);
}

std::vector<std::size_t> LoopCloser::accept(const std::vector<std::size_t>& agreeing) {
  const std::string telling = what_tells(ledger_, told_apart_, agreeing, options_.most_ambiguous);
  const std::size_t newest = agreeing.back();
  // Only those that tell are acted on: the others may lie anywhere along a wall that looks alike.
  std::vector<std::size_t> accepted;
  for (const std::size_t i : clear_of(agreeing)) {
    if (ledger_[i].state != HypothesisState::open) continue;
    // That others agree with it along an open direction says nothing of them.
    if (i != newest && ledger_[newest].has_open_direction()) continue;
    ledger_[i].state = HypothesisState::accepted;
    ledger_[i].decided_by = DecidedBy::evidence;
    ledger_[i].decided_with = newest;
    ledger_[i].reason = agreeing.size() > 1 ? "agrees with others of the same passage"
                                            : "matches, and lies where the map had it already";
    ledger_[i].reason += telling;
    accepted.push_back(i);
  }
  return accepted;
}

std::vector<std::size_t> LoopCloser::consider_between(const Map& map, const InformationGraph& graph, Hypothesis found,
                                                      bool may_join) {
  follow_ways(map);
  found.reason = may_join ? kWaits : "a proposal: islands are joined by sightings";
  const PatchId b = found.b;
  const std::vector<BoundedPose> about_b = tree_bound(graph, map.poses(), b.value, passage_about(map, b));
  constexpr Quorum kNever{std::numeric_limits<std::size_t>::max(), HUGE_VAL};
  return enter(map, graph, about_b, std::move(found),
               may_join ? Quorum{options_.least_agreeing_islands, options_.least_way_islands} : kNever);
}

std::vector<std::size_t> LoopCloser::consider_within(const Map& map, const InformationGraph& graph, Hypothesis found) {
  follow_ways(map);
  found.reason = kWaits;
  const std::vector<BoundedPose> about_b = tree_bound(graph, map.poses(), found.b.value, passage_about(map, found.b));
  return enter(map, graph, about_b, std::move(found), {options_.least_agreeing, options_.least_way});
}

void LoopCloser::compare_with_earlier(const Map& map, const InformationGraph& graph,
                                      std::span<const BoundedPose> about_b, std::size_t entry) {
  Hypothesis& h = ledger_[entry];
  const std::vector<BoundedPose> about_a = tree_bound(graph, map.poses(), h.a.value, passage_about(map, h.a));
  const std::size_t first = entry > options_.memory ? entry - options_.memory : 0;
  for (std::size_t i = 0; i < entry; ++i) {
    const Hypothesis& other = ledger_[i];
    // What an operator said is not forgotten, and holds for another comparison of the same patch, too.
    if (!other.is_withheld() && (i < first || other.b == h.b || other.state == HypothesisState::rejected)) continue;
    const BoundedPose* a_other = find(about_a, other.a);
    const BoundedPose* b_other = find(about_b, other.b);
    if (a_other == nullptr || b_other == nullptr) continue;
    const UncertainPose2 around = compound(compound(a_other->relative, other.T_a_b), invert(b_other->relative));
    if (confidence_interval(around.covariance).position > 1.0) continue;
    const bool agrees = disagreement(around, h.T_a_b) < options_.consistent;
    (agrees ? h.supports : h.conflicts).push_back(i);
  }
}

}  // namespace helicoid
