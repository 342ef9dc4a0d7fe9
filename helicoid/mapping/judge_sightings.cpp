#include "helicoid/mapping/judge_sightings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "helicoid/fit/half_solves.hpp"
#include "helicoid/fit/relative_covariance.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/sighting_fit.hpp"
#include "helicoid/mapping/sighting_rivals.hpp"

namespace helicoid {

namespace {

/// The exact relative covariance of any two places of one island (eq. 9-10), factorised when first asked for. Robots
/// that are near see each other again and again from the same patches: half solves are kept.
class ExactPoses {
 public:
  explicit ExactPoses(const Map& map) : map_(map) {
    for (Island& island : map.islands()) {
      const IslandId id = island.id;
      islands_.emplace(id, Known{std::move(island), {}, {}});
    }
  }
  /// T_p_q with its covariance, noise floors of the two scans included; nothing if the map leaves it open.
  std::optional<UncertainPose2> between(const PlacedRobot& robot_p, const PlacedRobot& robot_q) {
    const ManifoldPose& p = robot_p.pose;
    const ManifoldPose& q = robot_q.pose;
    Known& known = islands_.at(map_.island_of(p.patch));
    if (!known.covariance) factorise(known);
    if (!known.covariance->is_determined()) return std::nullopt;
    UncertainPose2 T{map_.T_plane_patch(p.patch).inverse() * map_.T_plane_patch(q.patch), Matrix3d::Zero()};
    if (p.patch != q.patch) {
      T.covariance =
          known.halves->relative_covariance(T.T_a_b, known.island.place_of(p.patch), known.island.place_of(q.patch));
    }
    T = compound(compound(invert({p.T_patch_robot, robot_p.covariance}), T), {q.T_patch_robot, robot_q.covariance});
    const LaserModel& of_p = map_.patch(p.patch).laser;
    const LaserModel& of_q = map_.patch(q.patch).laser;
    T.covariance = with_noise_floor(T, noise_floor(of_p.floor_position, of_p.floor_heading),
                                    noise_floor(of_q.floor_position, of_q.floor_heading));
    return T;
  }

 private:
  struct Known {
    Island island;
    std::unique_ptr<RelativeCovariance> covariance;
    std::unique_ptr<HalfSolves> halves;  ///< if it is determined and of two patches at least
  };
  void factorise(Known& known) const {
    const std::vector<Pose2> poses = island_poses(map_, known.island);
    const std::vector<GraphEdge> edges = graph_edges(map_, known.island);
    known.covariance = std::make_unique<RelativeCovariance>(poses, edges);
    if (poses.size() > 1 && known.covariance->is_determined()) {
      known.halves = std::make_unique<HalfSolves>(known.covariance->system());
    }
  }
  const Map& map_;
  std::map<IslandId, Known> islands_;
};

/// A sighting beside the finished map, for one candidate.
struct Judged {
  SightingFit fit;
  UncertainPose2 T;  ///< T_observer_observed as the map has it
};
std::optional<Judged> judge(const Map& map, ExactPoses& exact, const SightingRecord& record, const SeenCandidate& c) {
  if (map.island_of(record.observer_at.pose.patch) != map.island_of(c.at.pose.patch) || !is_usable(record.sighting))
    return std::nullopt;
  const std::optional<UncertainPose2> T = exact.between(record.observer_at, c.at);
  // Where the map itself is too vague, agreement would mean nothing.
  if (!T || confidence_interval(T->covariance).position > 1.0) return std::nullopt;
  return Judged{fit_of(record.sighting, *T), *T};
}

/// Open, or rejected by the scans of its time: with little mapped yet, people and doors weigh much.
bool may_be_settled(const Hypothesis& h) {
  return h.is_undecided() || (h.state == HypothesisState::rejected && h.decided_by == DecidedBy::evidence);
}

void settle(const Map& map, LoopCloser& closer, ExactPoses& exact, const SightingRecord& record) {
  std::vector<const SeenCandidate*> fitting;
  std::size_t judged = 0;
  std::optional<Judged> last;
  for (const SeenCandidate& c : record.candidates) {
    const std::optional<Judged> found = judge(map, exact, record, c);
    if (!found) continue;
    ++judged;
    last = found;
    if (found->fit.measurements > 0 && found->fit.agrees()) fitting.push_back(&c);
  }
  if (judged == 0) return;
  Hypothesis h = closer.ledger()[record.entry];
  const bool was_rejected = h.state == HypothesisState::rejected;
  if (fitting.size() == 1 && judged == record.candidates.size()) {
    h = entry_of(record, *fitting.front());
    h.state = HypothesisState::accepted;
    h.reason = "fits the map as it has become by other evidence";
  } else if (was_rejected) {
    return;
  } else if (!fitting.empty()) {
    h.reason = "may be of more robots than one";
  } else if (judged == record.candidates.size()) {
    h.state = HypothesisState::rejected;
    h.reason = fmt::format("does not fit the map: there the robot was {:.2f} m away in direction {:.0f} deg",
                           last->T.T_a_b.distance(), degrees(std::atan2(last->T.T_a_b.y, last->T.T_a_b.x)));
  }
  if (h.state != HypothesisState::open) h.decided_by = DecidedBy::evidence;
  closer.revise(record.entry, std::move(h));
}

}  // namespace

void judge_sightings(const Map& map, LoopCloser& closer, const SightingLog& log) {
  ExactPoses exact(map);
  for (const SightingRecord& record : log.placed()) {
    if (may_be_settled(closer.ledger()[record.entry])) settle(map, closer, exact, record);
  }
}

namespace {

/// Why what was mapped later speaks against an accepted sighting; empty if it does not.
struct Objections {
  std::string by_scans, by_sightings;
  double chi2 = 0;  ///< of the sighting beside the finished map, where the scans do not confirm it
};
Objections object_to(const Map& map, const InformationGraph& graph, ExactPoses& exact, const Ledger& ledger,
                     const SightingLog& log, const SightingRecord& record, const SeenCandidate& of) {
  Objections found;
  const std::optional<UncertainPose2> T_map = exact.between(record.observer_at, of.at);
  SharedGround ground;
  if (T_map) {
    ground = compare_ground(map, graph, {record.observer_at.pose, of.observers_side}, {of.at.pose, of.observed_side},
                            *T_map);
  }
  if (ground.verdict == Verdict::contradicted) {
    found.by_scans = fmt::format("what was mapped later contradicts it: {} points agree, {} lie deep in free space",
                                 ground.agreeing, ground.against);
  }
  const SightingVotes votes = count_votes(map, ledger, log, of.observers_side, of.observed_side);
  if (votes.for_other > votes.for_map) {
    found.by_sightings = fmt::format("{} sightings agree with one another and not with it, {} agree with it",
                                     votes.for_other, votes.for_map);
  }
  if (ground.verdict == Verdict::confirmed) return found;
  const std::optional<Judged> judged = judge(map, exact, record, of);
  if (judged && !judged->fit.agrees()) found.chi2 = judged->fit.chi2;
  return found;
}

}  // namespace

std::vector<Decision> find_regrets(const Map& map, const InformationGraph& graph, const LoopCloser& closer,
                                   const SightingLog& log, std::size_t most) {
  ExactPoses exact(map);
  std::vector<Decision> regrets;
  std::vector<std::pair<double, Decision>> misfits;  // with their chi^2
  for (const SightingRecord& record : log.placed()) {
    const Hypothesis& h = closer.ledger()[record.entry];
    if (h.state != HypothesisState::accepted || h.decided_by != DecidedBy::sighting) continue;
    const SeenCandidate& of = *std::find_if(record.candidates.begin(), record.candidates.end(),
                                            [&](const SeenCandidate& c) { return c.robot == h.seen->identified; });
    const Objections objections = object_to(map, graph, exact, closer.ledger(), log, record, of);
    Decision regret{HypothesisState::rejected,
                    HypothesisSource::sighting,
                    first_place(map, h),
                    second_place(map, h),
                    0,
                    DecidedBy::evidence,
                    ""};
    if (!objections.by_scans.empty() || !objections.by_sightings.empty()) {
      regret.reason = objections.by_scans.empty() ? objections.by_sightings : objections.by_scans;
      regrets.push_back(std::move(regret));
    } else if (objections.chi2 > 0) {
      regret.reason = fmt::format("what was mapped later leads elsewhere: chi^2 {:.1f}", objections.chi2);
      misfits.emplace_back(objections.chi2, std::move(regret));
    }
  }
  // One that the scans or many sightings contradict may be why another does not fit.
  if (!regrets.empty()) return regrets;
  std::stable_sort(misfits.begin(), misfits.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
  for (std::size_t i = 0; i < std::min(most, misfits.size()); ++i) regrets.push_back(std::move(misfits[i].second));
  return regrets;
}

}  // namespace helicoid
