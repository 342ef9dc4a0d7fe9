#include "helicoid/mapping/sighting_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "helicoid/mapping/sighting_fit.hpp"

namespace helicoid {

namespace {

constexpr double kSameStamp = 2e-6;  ///< a trajectory's stamps are rounded, seconds
constexpr double kStampShare = 0.3;  ///< of the way from scan to scan: what logged stamps are uncertain by
constexpr double kOpen = 1e3;        ///< standard deviation of what was not measured

/// What a sighting says of the relative pose; what it does not say is as good as open.
UncertainPose2 as_pose(Sighting s) {
  const auto open = [](std::optional<double>& value, double& sigma, double guess) {
    if (value) return;
    value = guess;
    sigma = kOpen;
  };
  open(s.range, s.sigma_range, 1);
  open(s.bearing, s.sigma_bearing, 0);
  open(s.orientation, s.sigma_orientation, 0);
  return *whole_pose(s);
}

/// What the scans say of its candidates on other islands, if it says all.
void ask_scans(const Map& map, const InformationGraph& graph, SightingRecord& record) {
  record.ask_again_at = map.patch_count() + record.wait;
  record.wait *= 2;
  const std::optional<UncertainPose2> T = is_usable(record.sighting) ? whole_pose(record.sighting) : std::nullopt;
  const IslandId here = map.island_of(record.observer_at.pose.patch);
  for (SeenCandidate& c : record.candidates) {
    const IslandId there = map.island_of(c.at.pose.patch);
    if (here == there) {
      c.observers_side = {record.observer};
      c.observed_side = {c.robot};
      continue;
    }
    c.observers_side = robots_on(map, here);
    c.observed_side = robots_on(map, there);
    if (!T || c.ground.verdict != Verdict::silent) continue;
    c.ground =
        compare_ground(map, graph, {record.observer_at.pose, c.observers_side}, {c.at.pose, c.observed_side}, *T);
  }
}

bool is_silent(const Map& map, const SightingRecord& record) {
  return std::any_of(record.candidates.begin(), record.candidates.end(), [&](const SeenCandidate& c) {
    return c.ground.verdict == Verdict::silent &&
           map.island_of(record.observer_at.pose.patch) != map.island_of(c.at.pose.patch);
  });
}

/// Islands are never parted again, and what is decided stays so: then nothing is asked of it any more.
bool is_in_question(const Map& map, const SightingRecord& record, const Hypothesis& entry) {
  if (!entry.is_undecided() && !is_ordered(entry)) return false;
  const IslandId here = map.island_of(record.observer_at.pose.patch);
  return std::any_of(record.candidates.begin(), record.candidates.end(),
                     [&](const SeenCandidate& c) { return map.island_of(c.at.pose.patch) != here; });
}

const SeenCandidate& likeliest(const SightingRecord& record) {
  return *std::max_element(
      record.candidates.begin(), record.candidates.end(),
      [](const SeenCandidate& x, const SeenCandidate& y) { return x.ground.share() < y.ground.share(); });
}

void reject_if_contradicted(const SightingRecord& record, Hypothesis& h) {
  const bool left = std::any_of(record.candidates.begin(), record.candidates.end(),
                                [](const SeenCandidate& c) { return c.ground.verdict != Verdict::contradicted; });
  if (left) return;
  h.state = HypothesisState::rejected;
  h.decided_by = DecidedBy::evidence;
  h.reason = fmt::format(
      "the scans contradict it: so placed, {} points agree and {} lie deep in what another scan saw as free",
      likeliest(record).ground.agreeing, likeliest(record).ground.against);
}

/// As it enters the ledger: decided already by an operator, or by scans that leave no candidate.
Hypothesis first_entry(const Map& map, const SightingRecord& record, std::span<const Decision> decisions) {
  Hypothesis h = entry_of(record, likeliest(record));
  if (record.candidates.size() > 1) h.seen->identified = {};
  h.reason = "waits for others, or for scans, that tell how the islands lie";
  if (const Decision* decision = find_decision(decisions, map, h)) {
    h.state = decision->state;
    h.decided_by = decision->by;
    h.reason = decision->reason.empty() ? "decided without looking at others" : decision->reason;
  } else {
    reject_if_contradicted(record, h);
  }
  return h;
}

}  // namespace

std::optional<PlacedRobot> place_at(const Map& map, RobotId robot, double stamp, bool last) {
  const auto& scans = map.robot(robot).trajectory;
  // The last in order: stamps may step back, and a sighting is recent.
  const std::size_t i = scans.last_not_after(stamp + kSameStamp);
  if (i == scans.size()) return std::nullopt;
  const bool newest = i + 1 == scans.size();
  if (newest && !last && scans.stamp(i) < stamp - kSameStamp) return std::nullopt;
  const TrackedScan before = scans[i];
  PlacedRobot placed{before.pose, before.covariance};
  if (i > 0) placed.add_motion(map.project(scans[i - 1].pose).inverse() * map.project(before.pose));
  if (newest) return placed;
  const TrackedScan after = scans[i + 1];
  const double share = std::max(0.0, stamp - before.stamp) / std::max(after.stamp - before.stamp, 1e-9);
  const Pose2 T_before_after = map.project(before.pose).inverse() * map.project(after.pose);
  placed.add_motion(T_before_after);
  placed.pose.T_patch_robot = before.pose.T_patch_robot * exponential(std::min(share, 1.0) * logarithm(T_before_after));
  return placed;
}

void PlacedRobot::add_motion(const Pose2& T_before_after) {
  const double along = kStampShare * T_before_after.distance();
  const double turn = kStampShare * T_before_after.yaw;
  covariance.diagonal() += Vector3d(along * along, along * along, turn * turn);
}

void SightingLog::add(RobotId observer, std::optional<RobotId> observed, double stamp, const Sighting& sighting) {
  waiting_.push_back({observer, observed, stamp, sighting});
}

std::optional<SightingRecord> SightingLog::place(const Map& map, const Waiting& w, bool last) {
  const std::optional<PlacedRobot> observer = place_at(map, w.observer, w.stamp, last);
  if (!observer) return std::nullopt;
  SightingRecord record{w.observer, w.stamp, w.sighting, *observer, {}, 0, 0, 1};
  for (std::size_t i = 0; i < map.robots().size(); ++i) {
    const RobotId robot = make_id<RobotId>(i);
    if (robot == w.observer || (w.observed && *w.observed != robot)) continue;
    const std::optional<PlacedRobot> pose = place_at(map, robot, w.stamp, last);
    // Whoever is heard of later may have been there, too: it has to be waited for.
    if (!pose && !last) return std::nullopt;
    if (pose) record.candidates.push_back({robot, *pose, {}, {}, {}});
  }
  if (record.candidates.empty()) return std::nullopt;
  return record;
}

bool SightingLog::place_waiting(const Map& map, const InformationGraph& graph, LoopCloser& closer,
                                std::span<const Decision> decisions, bool last) {
  std::erase_if(in_question_,
                [&](std::size_t i) { return !is_in_question(map, placed_[i], closer.ledger()[placed_[i].entry]); });
  bool fresh = ask_again(map, graph, closer, last);
  std::erase_if(waiting_, [&](const Waiting& w) {
    std::optional<SightingRecord> record = place(map, w, last);
    if (!record) return false;
    ask_scans(map, graph, *record);
    record->entry = closer.ledger().size();
    closer.record(first_entry(map, *record, decisions));
    if (is_in_question(map, *record, closer.ledger().back())) in_question_.push_back(placed_.size());
    placed_.push_back(std::move(*record));
    fresh = true;
    return true;
  });
  return fresh;
}

bool SightingLog::ask_again(const Map& map, const InformationGraph& graph, LoopCloser& closer, bool last) {
  bool fresh = false;
  for (const std::size_t i : in_question_) {
    SightingRecord& record = placed_[i];
    if (map.patch_count() < record.ask_again_at && !last) continue;
    if (!closer.ledger()[record.entry].is_undecided() || !is_silent(map, record)) continue;
    ask_scans(map, graph, record);
    if (is_silent(map, record)) continue;
    fresh = true;
    Hypothesis h = closer.ledger()[record.entry];
    reject_if_contradicted(record, h);
    closer.revise(record.entry, std::move(h));
  }
  return fresh;
}

bool is_ordered(const Hypothesis& entry) {
  return entry.state == HypothesisState::accepted && entry.decided_by == DecidedBy::operator_;
}

Hypothesis entry_of(const SightingRecord& record, const SeenCandidate& candidate) {
  Hypothesis h;
  h.source = HypothesisSource::sighting;
  const PatchId observer = record.observer_at.pose.patch;
  const PatchId observed = candidate.at.pose.patch;
  h.a = std::min(observer, observed);
  h.b = std::max(observer, observed);
  h.seen = {record.observer, record.stamp, record.sighting.observed, candidate.robot, observer == h.a};
  const UncertainPose2 T_observer_observed = as_pose(record.sighting);
  UncertainPose2 T = compound(compound({record.observer_at.pose.T_patch_robot, Matrix3d::Zero()}, T_observer_observed),
                              {candidate.at.pose.T_patch_robot.inverse(), Matrix3d::Zero()});
  h.T_a_b = observer == h.a ? T : invert(T);
  h.score = candidate.ground.share();
  return h;
}

}  // namespace helicoid
