#include "apps/team_pilot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/map_run.hpp"

namespace helicoid {

struct TeamPilot::Member {
  RobotId robot;
  bool reachable = true;
  double battery = 1;
  ManifoldPose pose;
  ManifoldPoint home;
  Scan scan;
  RouteFollower follower;
  Goal goal;
  bool has_way = false;
  bool is_blocked = false;
  bool has_arrived = false;
  double way_found_at = -HUGE_VAL;
  double way_left = 0;             ///< of the way, when last steered, metres
  double aside_until = -HUGE_VAL;  ///< it makes room for another one, seconds
  struct Closed {
    ClosedFloor floor;
    double until = 0;
  };
  std::vector<Closed> closed;

  /// Nothing keeps it where it stands.
  [[nodiscard]] bool is_idle() const {
    return reachable && (goal.kind == GoalKind::stay || (goal.kind == GoalKind::home && has_arrived));
  }
};

namespace {

/// Adds the CPU time of a scope to a sum.
class Timed {
 public:
  explicit Timed(double& sum) : sum_(sum), began_(thread_cpu_seconds()) {}
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;
  ~Timed() { sum_ += thread_cpu_seconds() - began_; }

 private:
  double& sum_;
  double began_;
};

Decision decision_about(const Map& map, const Hypothesis& h, HypothesisState state, const std::string& reason) {
  Decision decision;
  decision.state = state;
  decision.source = h.source;
  decision.a = first_place(map, h);
  decision.b = second_place(map, h);
  decision.reason = reason;
  return decision;
}

}  // namespace

TeamPilot::TeamPilot(const PilotOptions& options, std::span<const std::string> names, const LaserModel& laser,
                     std::vector<std::size_t> steered, Planner planner)
    : options_(options),
      laser_(laser),
      mapper_(options.mapper),
      explorer_(options.explorer),
      planner_(std::move(planner)),
      steered_(std::move(steered)) {
  for (const std::string& name : names) mapper_.add_robot(name, {laser});
}
TeamPilot::~TeamPilot() = default;
TeamPilot::TeamPilot(TeamPilot&&) noexcept = default;
TeamPilot& TeamPilot::operator=(TeamPilot&&) noexcept = default;

TeamPilot::Member* TeamPilot::member(RobotId robot) {
  const auto found = std::find_if(members_.begin(), members_.end(), [&](const Member& m) { return m.robot == robot; });
  return found == members_.end() ? nullptr : &*found;
}

void TeamPilot::take(const Event& event) {
  const Timed timed(times_.map_s);
  const Step step = mapper_.process(event);
  if (const auto* sighting = std::get_if<Sighting>(&event.body)) tell_of(event, *sighting);
  const auto* scan = std::get_if<Scan>(&event.body);
  if (scan == nullptr || std::find(steered_.begin(), steered_.end(), event.robot.index()) == steered_.end()) return;
  Member* m = member(event.robot);
  if (m == nullptr) {
    FollowerOptions follower = options_.follower;
    follower.right_of_way = static_cast<int>(event.robot.index());
    Member& begun = members_.emplace_back();
    begun.robot = event.robot;
    begun.home = point_of(step.pose);
    begun.follower = RouteFollower(follower);
    begun.pose = step.pose;
    begun.scan = *scan;
    journal_.push_back({event.stamp, JournalKind::joined, name(event.robot), "begins on an island of its own"});
    return;
  }
  m->pose = step.pose;
  m->scan = *scan;
}

void TeamPilot::tell_of(const Event& event, const Sighting& sighting) {
  const auto& robots = map().robots();
  const auto observed =
      std::find_if(robots.begin(), robots.end(), [&](const RobotRecord& r) { return r.name == sighting.observed; });
  if (observed == robots.end()) return;
  const RobotRecord& observer = map().robot(event.robot);
  if (observer.trajectory.empty() || observed->trajectory.empty()) return;
  const auto island = [&](const RobotRecord& r) { return map().island_of(r.trajectory.back().pose.patch); };
  explorer_.saw({event.stamp, event.robot, make_id<RobotId>(static_cast<std::size_t>(observed - robots.begin())),
                 sighting.range, island(observer) != island(*observed)});
}

void TeamPilot::plan(double now, std::span<const Order> orders) {
  if (members_.empty()) return;
  for (const Order& order : orders) {
    if (order.kind == OrderKind::forbid) forbidden_.push_back({order.point.patch, order.region_patch});
  }
  compare_islands(now);
  note_islands(now);
  note_closures(now);
  std::vector<DistanceField> fields;
  std::vector<Travel> travel;
  std::vector<TeamMember> team;
  Neighbours neighbours;
  {
    const Timed timed(times_.floor_s);
    neighbours = driven_.add_to(map(), find_neighbours(map()));
    floor_ = NavigableMap(map(), neighbours, options_.navigation, floor_ ? &*floor_ : nullptr);
    floor_->forbid(forbidden_);
    for (const Member& m : members_) fields.push_back(distances_from(*floor_, m.pose));
  }
  const Timed timed(times_.plan_s);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Member& m = members_[i];
    team.push_back({m.robot, m.pose, m.reachable, m.battery, m.home});
    travel.emplace_back([&fields, i](const ManifoldPoint& p) { return fields[i].metres_to(p); });
  }
  plan_ = planner_ ? planner_(now, map(), neighbours, travel, team)
                   : explorer_.plan(now, map(), neighbours, travel, team, open_doubts(), orders);
  for (const Settled& settled : plan_.settled) settle(now, settled);
  for (const Goal& goal : plan_.goals) {
    if (Member* m = member(goal.robot)) direct(*m, goal, now);
  }
}

void TeamPilot::direct(Member& m, const Goal& goal, double now) {
  const bool same = goal.kind == m.goal.kind && goal.point.patch == m.goal.point.patch &&
                    (goal.point.p_patch - m.goal.point.p_patch).norm() < 0.05;
  if (!same && goal.kind != GoalKind::stay) {
    journal_.push_back({now, JournalKind::goal, name(m.robot), fmt::format("{}: {}", name_of(goal.kind), goal.reason)});
  }
  m.goal = goal;
  const bool rests = goal.kind == GoalKind::stay || goal.kind == GoalKind::home;
  if (rests && now < m.aside_until) return;
  m.aside_until = -HUGE_VAL;
  if (goal.kind == GoalKind::stay) {
    m.follower.stop();
    m.has_way = false;
  } else if (!same || !m.has_way || now - m.way_found_at >= options_.route_period) {
    find_way(m, now, same);
  }
}

void TeamPilot::find_way(Member& m, double now, bool goes_on) {
  std::erase_if(m.closed, [&](const Member::Closed& c) { return c.until < now; });
  std::vector<ClosedFloor> closed;
  for (const Member::Closed& c : m.closed) closed.push_back(c.floor);
  ManifoldRoute route = plan_route(*floor_, m.pose, m.goal.point, closed);
  if (route.status != RouteStatus::found && !closed.empty()) route = plan_route(*floor_, m.pose, m.goal.point);
  m.way_found_at = now;
  const bool drives = goes_on && m.has_way && !m.has_arrived;
  if (drives && only_leads_back(*floor_, m.follower.route(), m.way_left, route)) return;
  m.has_way = route.status == RouteStatus::found;
  m.way_left = route.length;
  if (m.has_way) {
    std::optional<ManifoldHeading> heading;
    if (m.goal.heading_patch) heading = ManifoldHeading{m.goal.point.patch, *m.goal.heading_patch};
    m.follower.follow(std::move(route), heading);
  } else {
    m.follower.stop();
  }
}

DriveCommand TeamPilot::steer(std::size_t robot, double now, double dt) {
  const Timed timed(times_.steer_s);
  Member* m = member(make_id<RobotId>(robot));
  if (m == nullptr) return {};
  // Without a way, too: what it remembers of its surroundings grows old.
  const FollowStep step = m->follower.step(map(), m->pose, m->scan, laser_, dt);
  if (!m->has_way) return {};
  m->has_arrived = step.status == FollowStatus::arrived;
  m->way_left = step.left;
  if (step.status != FollowStatus::blocked) {
    m->is_blocked = false;
    return step.command;
  }
  if (m->is_blocked) return step.command;
  m->is_blocked = true;
  journal_.push_back({now, JournalKind::blocked, name(m->robot), "something stands in the way"});
  if (now < m->aside_until) return step.command;  // who is to pass backs off first
  if (step.obstruction && !is_let_pass(*m, *step.obstruction, now)) {
    m->closed.push_back({{*step.obstruction, options_.closed_radius}, now + options_.closed_for});
  }
  find_way(*m, now, !step.obstruction);
  return step.command;
}

/// Whether what blocks a robot is another one that has nothing to do, and that now makes room.
bool TeamPilot::is_let_pass(const Member& blocked, const ManifoldPoint& obstruction, double now) {
  const std::vector<ManifoldPoint>& way = blocked.follower.route().points;
  const ClosedFloor stand{point_of(blocked.pose), options_.closed_radius};
  for (Member& other : members_) {
    if (&other == &blocked || !other.is_idle()) continue;
    if (map().island_of(other.pose.patch) != map().island_of(obstruction.patch)) continue;
    const Vector2d at = project(map(), point_of(other.pose));
    if ((at - project(map(), obstruction)).norm() > options_.in_the_way) continue;
    ManifoldRoute aside = plan_route_aside(*floor_, other.pose, way, {&stand, 1});
    // Where it can only come out, the other will back off before it.
    if (aside.status != RouteStatus::found) aside = plan_route_aside(*floor_, other.pose, way);
    if (aside.status != RouteStatus::found) continue;
    other.follower.follow(std::move(aside));
    other.has_way = true;
    other.has_arrived = false;
    other.way_found_at = now;
    other.aside_until = now + options_.aside_for;
    journal_.push_back({now, JournalKind::goal, name(other.robot), "aside: lets " + name(blocked.robot) + " pass"});
    return true;
  }
  return false;
}

void TeamPilot::set_reachable(std::size_t robot, bool reachable) {
  if (Member* m = member(make_id<RobotId>(robot))) m->reachable = reachable;
}

void TeamPilot::set_battery(std::size_t robot, double battery) {
  if (Member* m = member(make_id<RobotId>(robot))) m->battery = battery;
}

void TeamPilot::note_islands(double now) {
  const std::size_t islands = map().islands().size();
  const std::size_t given = map().island_count();
  const std::size_t merges = given - islands;
  if (merges > merges_) {
    journal_.push_back({now, JournalKind::merge, "", fmt::format("islands are joined; {} left", islands)});
  }
  merges_ = merges;
}

void TeamPilot::note_closures(double now) {
  const std::size_t closures = count_closures(mapper_.ledger());
  if (closures > closures_) {
    journal_.push_back({now, JournalKind::closure, "", fmt::format("{} places are known again", closures - closures_)});
  }
  closures_ = closures;
}

std::vector<Doubt> TeamPilot::open_doubts() const {
  std::vector<Doubt> doubts;
  const Ledger& ledger = mapper_.ledger();
  for (std::size_t i = 0; i < ledger.size(); ++i) {
    const Hypothesis& h = ledger[i];
    if (h.is_undecided() && h.source == HypothesisSource::lookalike) {
      doubts.push_back({i, h.a, h.b, h.T_a_b, h.ambiguity});
    }
  }
  return doubts;
}

void TeamPilot::compare_islands(double now) {
  const bool asks = options_.greedy || (options_.explorer.meet && !planner_);
  if (!asks || members_.size() < 2 || now - proposed_at_ < options_.propose_period) return;
  const Timed timed(times_.map_s);
  proposed_at_ = now;
  mapper_.propose();
  if (!options_.greedy) return;
  for (std::size_t i = 0; i < mapper_.ledger().size(); ++i) {
    const Hypothesis h = mapper_.ledger()[i];
    if (!h.is_undecided() || h.source != HypothesisSource::lookalike) continue;
    mapper_.decide(decision_about(map(), h, HypothesisState::accepted, "it looks alike"));
  }
}

void TeamPilot::settle(double now, const Settled& settled) {
  const Hypothesis& h = mapper_.ledger()[settled.doubt];
  const bool met = settled.outcome == MeetingOutcome::met;
  journal_.push_back({now, JournalKind::rendezvous, name(settled.watcher), settled.reason});
  if (!h.is_undecided()) return;
  mapper_.decide(decision_about(map(), h, met ? HypothesisState::accepted : HypothesisState::distinct, settled.reason));
}

}  // namespace helicoid
