#include "helicoid/mapping/sighting_rivals.hpp"

#include <algorithm>

#include "helicoid/mapping/sighting_fit.hpp"

namespace helicoid {

namespace {

/// How well two robots' ways are known to lie within one side, roughly.
constexpr double kPosition = 0.3;  ///< metres
constexpr double kHeading = 0.1;   ///< radians
/// Votes are compared pair by pair: more of them would decide nothing that so many do not.
constexpr std::size_t kMostVotes = 300;

/// A sighting that the map does not fit. Where the other side would have to be moved to, in the plane, follows from it.
struct Objection {
  Pose2 T_plane_observer, T_plane_observed;
  bool from_one_side = true;  ///< the other side is the observed robot's
  const Sighting* sighting = nullptr;

  [[nodiscard]] Pose2 correction() const {
    const Pose2 T_plane_said = T_plane_observer * whole_pose(*sighting)->T_a_b;
    return from_one_side ? T_plane_said * T_plane_observed.inverse() : T_plane_observed * T_plane_said.inverse();
  }
  [[nodiscard]] bool agrees_with(const Pose2& correction) const {
    UncertainPose2 T;
    T.T_a_b = from_one_side ? T_plane_observer.inverse() * correction * T_plane_observed
                            : (correction * T_plane_observer).inverse() * T_plane_observed;
    T.covariance.diagonal() << kPosition * kPosition, kPosition * kPosition, kHeading * kHeading;
    return fit_of(*sighting, T).agrees();
  }
};

bool is_among(std::span<const RobotId> robots, RobotId robot) {
  return std::count(robots.begin(), robots.end(), robot) > 0;
}

}  // namespace

SightingVotes count_votes(const Map& map, const Ledger& ledger, const SightingLog& log,
                          std::span<const RobotId> one_side, std::span<const RobotId> other_side) {
  SightingVotes votes;
  std::vector<Objection> objections;
  for (const SightingRecord& record : log.placed()) {
    if (record.candidates.size() != 1 || !is_usable(record.sighting) || !whole_pose(record.sighting)) continue;
    const SeenCandidate& seen = record.candidates.front();
    const bool from_one = is_among(one_side, record.observer) && is_among(other_side, seen.robot);
    const bool from_other = is_among(other_side, record.observer) && is_among(one_side, seen.robot);
    if (!from_one && !from_other) continue;
    if (ledger[record.entry].state == HypothesisState::accepted) {
      ++votes.for_map;
    } else if (objections.size() < kMostVotes) {
      objections.push_back(
          {map.project(record.observer_at.pose), map.project(seen.at.pose), from_one, &record.sighting});
    }
  }
  for (const Objection& first : objections) {
    const Pose2 correction = first.correction();
    const auto agreeing = static_cast<std::size_t>(std::count_if(
        objections.begin(), objections.end(), [&](const Objection& o) { return o.agrees_with(correction); }));
    votes.for_other = std::max(votes.for_other, agreeing);
  }
  return votes;
}

}  // namespace helicoid
