#include "apps/explore_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/interrupt_guard.hpp"
#include "helicoid/io/laser_file.hpp"
#include "helicoid/simulation/simulator.hpp"

namespace helicoid {

namespace {

std::vector<std::string> names_of(std::size_t robots) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robots; ++i) names.push_back(simulated_robot_name(i));
  return names;
}

std::vector<std::size_t> all_of(std::size_t robots) {
  std::vector<std::size_t> all(robots);
  for (std::size_t i = 0; i < robots; ++i) all[i] = i;
  return all;
}

/// How many robots begin within three metres of an earlier one.
std::size_t side_by_side(std::span<const LiveRobot> robots) {
  constexpr double kSide = 3.0;
  std::size_t beside = 0;
  for (std::size_t i = 1; i < robots.size(); ++i) {
    const auto earlier = robots.first(i);
    beside += std::any_of(earlier.begin(), earlier.end(), [&](const LiveRobot& other) {
      return (other.T_world_start.translation() - robots[i].T_world_start.translation()).norm() < kSide;
    });
  }
  return beside;
}

/// What a run consists of while it goes on.
class Exploration {
 public:
  Exploration(const ExploreJob& job, LiveSimulation simulation, const LaserModel& laser)
      : job_(job),
        simulation_(std::move(simulation)),
        pilot_(job.pilot, names_of(job.robots.size()), laser, all_of(job.robots.size()), job.planner),
        recording_(job.robots.size(), "explore"),
        was_alive_(job.robots.size(), false),
        was_heard_(job.robots.size(), true) {
    if (!job.radio) return;
    radio_.emplace(job.world, job.robots.size(), *job.radio);
    for (std::size_t i = 0; i < job.robots.size(); ++i) {
      on_board_.emplace_back(job.pilot, names_of(job.robots.size()), laser, std::vector{i}, job.planner);
    }
  }

  void run() {
    while (!over_ && simulation_.now() < job_.longest && !InterruptGuard::interrupted()) {
      advance();
      if (simulation_.now() >= next_plan_ - 1e-9) plan();
      steer();
    }
  }

  ExploreRun finish(const LaserModel& laser);

 private:
  /// Stamps count from the simulation's beginning in what people read.
  [[nodiscard]] double stamp() const { return LiveSimulation::kFirstStamp + simulation_.now(); }
  [[nodiscard]] bool is_heard(std::size_t robot) const { return !radio_ || radio_->in_contact(robot); }

  void advance() {
    const double before = thread_cpu_seconds();
    std::vector<LiveEvent> events = simulation_.tick();
    sim_cpu_s_ += thread_cpu_seconds() - before;
    for (const LiveEvent& e : events) {
      recording_.note(e.event, e.T_world_robot);
      events_.push_back(e.event);
      if (radio_) on_board_[e.event.robot.index()].take(e.event);
    }
    hear(radio_ ? radio_->pass(std::move(events), simulation_) : std::move(events));
    for (std::size_t i = 0; i < was_alive_.size(); ++i) note_state(i);
  }

  void hear(const std::vector<LiveEvent>& events) {
    for (const LiveEvent& e : events) {
      const double began = thread_cpu_seconds();
      pilot_.take(e.event);
      if (std::holds_alternative<Scan>(e.event.body)) scan_seconds_.push_back(thread_cpu_seconds() - began);
    }
  }

  void note_state(std::size_t robot) {
    const bool alive = simulation_.alive(robot);
    if (was_alive_[robot] && !alive) {
      own_journal_.push_back({stamp(), JournalKind::died, simulated_robot_name(robot), "is not heard of any more"});
    } else if (alive && is_heard(robot) != was_heard_[robot]) {
      own_journal_.push_back({stamp(), JournalKind::radio, simulated_robot_name(robot),
                              was_heard_[robot] ? "out of contact: goes on by itself" : "in contact again"});
    }
    was_alive_[robot] = alive;
    was_heard_[robot] = is_heard(robot);
    pilot_.set_reachable(robot, alive && is_heard(robot));
    (is_heard(robot) ? pilot_ : on_board_[robot]).set_battery(robot, simulation_.battery(robot));
  }

  void plan() {
    next_plan_ = simulation_.now() + job_.plan_period;
    std::vector<Order> orders;
    if (job_.orders) orders = job_.orders(simulation_.now(), pilot_.map());
    operator_actions_ += orders.size();
    pilot_.plan(stamp(), orders);
    over_ = pilot_.team_plan().finished;
    for (std::size_t i = 0; i < was_alive_.size(); ++i) {
      if (is_heard(i) || !was_alive_[i]) continue;
      on_board_[i].plan(stamp());
      over_ = over_ && on_board_[i].team_plan().finished;
    }
    if (job_.observer && !job_.observer(simulation_.now(), simulation_, pilot_, recording_)) over_ = true;
  }

  void steer() {
    for (std::size_t i = 0; i < was_alive_.size(); ++i) {
      if (!was_alive_[i]) continue;
      TeamPilot& pilot = is_heard(i) ? pilot_ : on_board_[i];
      simulation_.command(i, pilot.steer(i, stamp(), job_.simulation.period));
    }
  }

  /// All events by their stamps, under these decisions, as run_map has them.
  [[nodiscard]] Mapper map_by_stamps(const std::vector<Decision>& decisions, const LaserModel& laser) const {
    MapperOptions options = job_.pilot.mapper;
    options.decisions = decisions;
    Mapper mapper(options);
    for (const std::string& name : names_of(job_.robots.size())) mapper.add_robot(name, {laser});
    for (const Event& event : events_) mapper.process(event);
    mapper.finish();
    return mapper;
  }

  void collect_journal(ExploreRun& run);
  void map_again(ExploreRun& run, const LaserModel& laser) const;

  const ExploreJob& job_;
  LiveSimulation simulation_;
  TeamPilot pilot_;
  SimulatedRecording recording_;
  ExploreJournal own_journal_;
  std::optional<Radio> radio_;
  std::vector<TeamPilot> on_board_;  ///< with a radio: what each robot would do by itself
  std::vector<Event> events_;        ///< of all robots, by stamp
  std::vector<double> scan_seconds_;
  std::vector<bool> was_alive_, was_heard_;
  double next_plan_ = 0;
  double sim_cpu_s_ = 0;
  std::size_t operator_actions_ = 0;
  bool over_ = false;
};

void Exploration::collect_journal(ExploreRun& run) {
  run.journal = pilot_.journal();
  run.journal.insert(run.journal.end(), own_journal_.begin(), own_journal_.end());
  for (const LiveSimulation::Contact& c : simulation_.contacts()) {
    run.journal.push_back({c.stamp, JournalKind::collision, simulated_robot_name(c.robot), "touches " + c.with});
  }
  std::stable_sort(run.journal.begin(), run.journal.end(),
                   [](const JournalEntry& a, const JournalEntry& b) { return a.stamp < b.stamp; });
  run.journal.push_back({stamp(), JournalKind::end, "", fmt::format("{}: {}", run.end_state, run.reason)});
  for (JournalEntry& e : run.journal) e.stamp -= LiveSimulation::kFirstStamp;
}

/// What was believed at once and what the finished map contradicts is undone, as run_map does it.
void Exploration::map_again(ExploreRun& run, const LaserModel& laser) const {
  std::vector<Decision> decisions = run.map.mapper.decisions();
  const auto regret = [&run] { return run.map.mapper.regrets(run.map.passes); };
  for (std::vector<Decision> regrets = regret(); !regrets.empty(); regrets = regret()) {
    decisions.insert(decisions.end(), regrets.begin(), regrets.end());
    run.map.mapper = map_by_stamps(decisions, laser);
    ++run.map.passes;
  }
}

ExploreRun Exploration::finish(const LaserModel& laser) {
  if (radio_) hear(radio_->hand_over());
  ExploreRun run(pilot_.release_mapper(), std::move(recording_));
  run.last_plan = pilot_.team_plan();
  run.operator_actions = operator_actions_;
  run.times = pilot_.times();
  run.end_state = over_ && run.last_plan.finished ? name_of(run.last_plan.end_state)
                  : InterruptGuard::interrupted() ? "interrupted"
                                                  : "time is up";
  run.reason = run.last_plan.reason;
  run.sim_s = simulation_.now();
  run.sim_cpu_s = sim_cpu_s_;
  const auto contacts = simulation_.contacts();
  run.contacts.assign(contacts.begin(), contacts.end());
  collect_journal(run);
  run.map.mapper.finish();
  run.map.passes = 1;
  if (radio_) {
    Mapper stamped = map_by_stamps(run.map.mapper.decisions(), laser);
    run.order = compare_orders(run.map.mapper, stamped);
    run.map.mapper = std::move(stamped);
    ++run.map.passes;
  }
  map_again(run, laser);
  const std::size_t joins = run.map.mapper.map().island_count() - run.map.mapper.map().islands().size();
  run.merges = joins - std::min(joins, side_by_side(job_.robots));
  run.map.scan_seconds = scan_seconds_;
  run.map.scans = scan_seconds_.size();
  run.map.interrupted = InterruptGuard::interrupted();
  run.map.skipped = skipped_by(run.map.mapper);
  for (std::size_t i = 0; i < job_.robots.size(); ++i) {
    run.map.logs.push_back(simulated_robot_name(i) + ".clf.gz");
    run.map.lasers.push_back(fmt::format("{}: {}", simulated_robot_name(i), describe(laser)));
  }
  return run;
}

}  // namespace

ExploreJob explore_from_starts(const World& world, std::size_t robots, std::uint64_t seed) {
  ExploreJob job;
  job.world = world;
  job.simulation.seed = seed;
  for (std::size_t i = 0; i < robots; ++i) job.robots.push_back({world.starts[i]});
  return job;
}

Result<ExploreRun> run_exploration(const ExploreJob& job) {
  const InterruptGuard guard;
  const double began = thread_cpu_seconds();
  Result<LiveSimulation> simulation = LiveSimulation::make(job.world, job.robots, job.simulation);
  if (!simulation) return tl::unexpected(simulation.error());
  const Result<LaserModel> laser = load_laser("sick-lms200", simulation->laser());
  if (!laser) return tl::unexpected(laser.error());
  Exploration exploration(job, std::move(*simulation), *laser);
  exploration.run();
  ExploreRun run = exploration.finish(*laser);
  run.cpu_s = thread_cpu_seconds() - began - run.sim_cpu_s;
  return run;
}

}  // namespace helicoid
