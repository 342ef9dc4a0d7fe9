// Does mapping keep up with fifty robots?
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "apps/chart.hpp"
#include "apps/experiments/list.hpp"
#include "apps/map_run.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/io/laser_file.hpp"
#include "helicoid/simulation/live_simulation.hpp"
#include "helicoid/simulation/starts.hpp"

namespace helicoid {

namespace {

constexpr double kPeriod = 0.2;  // five scans a second each
constexpr double kLongest = 3;   // times the time asked for, while not all have seen one another

/// Drives where there is room and turns where there is none: enough to get about in a hall.
class Wanderer {
 public:
  explicit Wanderer(Random random) : random_(random) {}

  DriveCommand decide(const Scan& scan, const LaserModel& laser) {
    const double ahead = room_ahead(scan, laser);
    if (turns_left_ <= 0 && ahead < kStop) {
      turns_left_ = 3 + static_cast<int>(random_.below(12));
      side_ = mean_range(scan, true) > mean_range(scan, false) ? 1 : -1;
    }
    if (turns_left_ > 0) {
      --turns_left_;
      return {0, side_ * 0.9};
    }
    bend_ = std::clamp(bend_ + 0.1 * random_.normal(), -0.3, 0.3);
    return {0.6 * std::clamp(ahead - kStop, 0.2, 1.0), bend_};
  }

 private:
  static constexpr double kStop = 0.7;    // metres
  static constexpr double kAside = 0.35;  // half the width of what counts as ahead, metres

  static double room_ahead(const Scan& scan, const LaserModel& laser) {
    double nearest = laser.max_range;
    for (int beam = 0; beam < laser.beams; ++beam) {
      const auto range = static_cast<double>(scan.ranges[static_cast<std::size_t>(beam)]);
      const double x = range * std::cos(laser.bearing(beam));
      const double y = range * std::sin(laser.bearing(beam));
      if (std::abs(y) < kAside && x > 0) nearest = std::min(nearest, x);
    }
    return nearest;
  }

  static double mean_range(const Scan& scan, bool left) {
    const auto half = static_cast<std::ptrdiff_t>(scan.ranges.size() / 2);
    const auto begin = scan.ranges.begin() + (left ? half : 0);
    const auto sum = [](double total, float range) { return total + std::min(static_cast<double>(range), 10.0); };
    return std::accumulate(begin, begin + half, 0.0, sum);
  }

  Random random_;
  int turns_left_ = 0;  ///< decisions
  int side_ = 1;
  double bend_ = 0;
};

struct SwarmRun {
  SimulatedRun mapped;
  std::vector<double> scan_us;    ///< in order
  std::vector<double> second_s;   ///< CPU seconds of mapping by simulated second
  std::vector<Vector2d> islands;  ///< seconds and how many
  double seconds = 0;
  std::size_t contacts = 0;
};

/// Who has seen whom, by themselves or in turn: until all have, there is nothing that could make one island of them.
class Acquaintance {
 public:
  explicit Acquaintance(std::size_t robots) : group_(robots) { std::iota(group_.begin(), group_.end(), 0U); }

  void note(std::size_t observer, const Sighting& sighting) {
    for (std::size_t i = 0; i < group_.size(); ++i) {
      if (simulated_robot_name(i) != sighting.observed) continue;
      const std::size_t joined = group_[i];
      std::replace(group_.begin(), group_.end(), joined, group_[observer]);
    }
  }

  [[nodiscard]] bool is_complete() const { return std::set(group_.begin(), group_.end()).size() == 1; }

 private:
  std::vector<std::size_t> group_;  ///< by robot: alike for those that have seen one another
};

Result<LiveSimulation> enter(const World& world, std::size_t robots, std::uint64_t seed) {
  StartOptions starts;
  starts.robots = robots;
  starts.seed = seed;
  const Result<std::vector<Pose2>> places = place_starts(world, starts);
  if (!places) return tl::unexpected(places.error());
  std::vector<LiveRobot> team;
  team.reserve(robots);
  for (const Pose2& place : *places) team.push_back({place});
  LiveOptions options;
  options.seed = seed;
  options.period = kPeriod;
  return LiveSimulation::make(world, std::move(team), options);
}

/// One event into the mapper, with its time.
void take(SwarmRun& run, const LiveEvent& event) {
  const double before = thread_cpu_seconds();
  run.mapped.mapper.process(event.event);
  const double spent = thread_cpu_seconds() - before;
  run.mapped.cpu_s += spent;
  run.second_s.back() += spent;
  if (!std::holds_alternative<Scan>(event.event.body)) return;
  run.scan_us.push_back(1e6 * spent);
  TrueTrack& track = run.mapped.tracks[event.event.robot.index()];
  track.stamps.push_back(event.event.stamp);
  track.T_world_robot.push_back(event.T_world_robot);
}

Result<SwarmRun> map_swarm(const World& world, std::size_t robots, double seconds, std::uint64_t seed) {
  Result<LiveSimulation> simulation = enter(world, robots, seed);
  if (!simulation) return tl::unexpected(simulation.error());
  const Result<LaserModel> laser = load_laser("sick-lms200", simulation->laser());
  if (!laser) return tl::unexpected(laser.error());
  SwarmRun run{{Mapper(), {}, 0}, {}, {}, {}, 0, 0};
  Acquaintance acquaintance(robots);
  std::vector<Wanderer> wanderers;
  Random random(seed);
  for (std::size_t i = 0; i < robots; ++i) {
    run.mapped.mapper.add_robot(simulated_robot_name(i), {*laser});
    run.mapped.tracks.push_back({simulated_robot_name(i), {}, {}});
    wanderers.emplace_back(random.split());
  }
  const auto is_over = [&](double now) { return now >= (acquaintance.is_complete() ? 1 : kLongest) * seconds; };
  while (!is_over(simulation->now() + 0.5 * kPeriod)) {
    const auto second = static_cast<std::size_t>(simulation->now());
    if (run.second_s.size() <= second) run.second_s.resize(second + 1, 0.0);
    for (const LiveEvent& event : simulation->tick()) {
      take(run, event);
      const std::size_t robot = event.event.robot.index();
      if (const auto* sighting = std::get_if<Sighting>(&event.event.body)) acquaintance.note(robot, *sighting);
      const auto* scan = std::get_if<Scan>(&event.event.body);
      if (scan == nullptr) continue;
      simulation->command(robot, wanderers[robot].decide(*scan, simulation->laser()));
    }
    run.islands.emplace_back(simulation->now(), static_cast<double>(run.mapped.map().islands().size()));
  }
  const double before = thread_cpu_seconds();
  run.mapped.mapper.finish();
  run.mapped.cpu_s += thread_cpu_seconds() - before;
  run.seconds = simulation->now();
  run.contacts = simulation->collisions();
  return run;
}

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

ExperimentPicture draw_load(const SwarmRun& run) {
  Chart load;
  load.title = "mapping: CPU time by second of the team's";
  load.x_label = "time (s)";
  load.y_label = "CPU (s)";
  load.y_from = 0.0;
  Series cpu{"", {}, charts::robot_colour(0), Series::Look::line};
  for (std::size_t i = 0; i < run.second_s.size(); ++i)
    cpu.points.emplace_back(static_cast<double>(i), run.second_s[i]);
  load.series = {cpu};
  load.height = 300;
  Chart islands = load;
  islands.title = "islands";
  islands.y_label = "islands";
  islands.series = {{"", run.islands, charts::robot_colour(1), Series::Look::line}};
  return {fmt::format("load-of-{}", run.mapped.map().robots().size()), draw_charts({load, islands})};
}

Outcome judge(const SwarmRun& run, std::uint64_t seed) {
  const std::span<const double> scans(run.scan_us);
  const std::size_t fifth = scans.size() / 5;
  RelationErrorOptions between;
  between.between_robots = true;
  const RelationError error = relation_error(run.mapped, seed, between);
  Outcome outcome{{{"driven_s", run.seconds},
                   {"mapping_load_percent", 100 * run.mapped.cpu_s / run.seconds},
                   {"busiest_second_s", *std::max_element(run.second_s.begin(), run.second_s.end())},
                   {"scan_p50_us", quantile(run.scan_us, 0.5)},
                   {"scan_p99_us", quantile(run.scan_us, 0.99)},
                   {"scan_mean_us", mean(scans)},
                   {"scan_growth_ratio", mean(scans.last(fifth)) / mean(scans.subspan(fifth, fifth))},
                   {"scans_count", static_cast<double>(scans.size())},
                   {"islands_count", static_cast<double>(run.mapped.map().islands().size())},
                   {"patches_count", static_cast<double>(run.mapped.map().patch_count())},
                   {"contacts_count", static_cast<double>(run.contacts)},
                   {"between_robots_mean_m", error.translation_m.mean},
                   {"between_robots_max_m", error.translation_m.max},
                   {"missing_relations_count", static_cast<double>(error.missing)}},
                  {}};
  if (seed == 1) outcome.pictures.push_back(draw_load(run));
  return outcome;
}

ExperimentCase make_case(const std::string& world_name, std::size_t robots, double seconds) {
  return {fmt::format("{}-{}", world_name, robots), true, "", [=](std::uint64_t seed) -> Result<Outcome> {
            const Result<World> world = load_world(world_name);
            if (!world) return tl::unexpected(world.error());
            const Result<SwarmRun> run = map_swarm(*world, robots, seconds, seed);
            if (!run) return tl::unexpected(run.error());
            return judge(*run, seed);
          }};
}

}  // namespace

Experiment swarm_experiment() {
  Experiment e;
  e.name = "swarm";
  e.question = "Does mapping keep up with fifty robots?";
  e.method =
      "Fifty robots in a hall of 64 by 44 m (depot) scan five times a second each for five minutes while they wander "
      "about; they begin in two groups, nobody knows where, and recognise one another within 8 m. As long as no "
      "sighting has led from one group to the other there is nothing to join them by: they drive on until one has, "
      "for fifteen minutes at most. The load is the mapper's CPU time, its last fit included, over the time that the "
      "team drove: 100 percent is one core of two. A scan's time is the CPU time of its whole step, with all that it "
      "set off; its growth is the last fifth of the scans over the second. Ten robots for comparison.";
  e.bars = {{"mapping_load_percent", std::nullopt, 200.0, false, true},
            {"islands_count", std::nullopt, 1.0, false},
            {"missing_relations_count", std::nullopt, 0.0, false}};
  e.seeds = 10;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions& options) {
    // In half a minute ten robots do not meet.
    if (options.quick) return std::vector<ExperimentCase>{make_case("depot", 50, 30)};
    return std::vector<ExperimentCase>{make_case("depot", 10, 300), make_case("depot", 50, 300)};
  };
  return e;
}

}  // namespace helicoid
