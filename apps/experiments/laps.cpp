// Does a robot that re-walks known ground add anything to the map?
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>

#include "apps/chart.hpp"
#include "apps/experiments/list.hpp"
#include "apps/process_memory.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/manifold/sheets.hpp"

namespace helicoid {

namespace {

constexpr int kLaps = 10;

/// What was there when a lap ended.
struct LapRecord {
  double patches = 0;
  double relations = 0;
  double map_bytes = 0;
  double resident_bytes = 0;
};

struct LapsResult {
  std::array<LapRecord, kLaps> laps{};
  double trajectory_bytes_per_scan = 0;
  double sheets = 0;
  double turn_relations = 0;  ///< between patches more than half a lap apart along the way
  double drift_m = 0;         ///< how far the plane is off after the last lap
};

LapRecord look(const Map& map) {
  // What is free again is not held, though the allocator may not have given it back yet.
  malloc_trim(0);
  // A simulated run keeps the true pose of every scan for the judge: a robot that maps does not.
  const std::size_t truth_bytes = map.robots()[0].trajectory.size() * (sizeof(double) + sizeof(Pose2));
  return {static_cast<double>(map.patch_count()), static_cast<double>(map.relations().size()),
          static_cast<double>(map_bytes(map)), static_cast<double>(resident_bytes() - truth_bytes)};
}

/// Way driven until each scan of the only robot.
std::vector<double> ways(const TrueTrack& track) {
  std::vector<double> way{0};
  for (std::size_t i = 1; i < track.T_world_robot.size(); ++i) {
    way.push_back(way.back() + (track.T_world_robot[i - 1].inverse() * track.T_world_robot[i]).distance());
  }
  return way;
}

LapsResult drive(const World& world, std::uint64_t seed, bool closures) {
  SimulationOptions options;
  options.seed = seed;
  options.laps = kLaps;
  MapperOptions mapper_options;
  mapper_options.closures = closures;
  LapsResult result;
  int lap = 0;
  const auto observe = [&](const SimulatedEvent& event, const Step&, const Mapper& mapper) {
    if (event.lap == lap) return;
    result.laps[static_cast<std::size_t>(lap)] = look(mapper.map());
    lap = event.lap;
  };
  const SimulatedRun run = map_simulation(world, options, mapper_options, observe).value();
  const Map& map = run.map();
  for (; lap < kLaps; ++lap) result.laps[static_cast<std::size_t>(lap)] = look(map);
  const std::vector<double> way = ways(run.tracks[0]);
  const auto way_of = [&](PatchId id) { return way[map.patch(id).scan_index]; };
  for (const Relation& r : map.relations()) {
    if (std::abs(way_of(r.a) - way_of(r.b)) > 0.5 * way.back() / kLaps) ++result.turn_relations;
  }
  const auto& trajectory = map.robots()[0].trajectory;
  result.trajectory_bytes_per_scan =
      static_cast<double>(trajectory_bytes(map)) / static_cast<double>(trajectory.size());
  const Pose2 T_first_last = map.project(trajectory.front().pose).inverse() * map.project(trajectory.back().pose);
  const Pose2 truth = run.tracks[0].T_world_robot.front().inverse() * run.tracks[0].T_world_robot.back();
  result.drift_m = (truth.inverse() * T_first_last).distance();
  for (const int sheets : count_sheets(map)) result.sheets = std::max(result.sheets, static_cast<double>(sheets));
  return result;
}

/// In a process of its own, whose memory is this run's alone.
Result<LapsResult> drive_alone(const World& world, std::uint64_t seed, bool closures) {
  static_assert(std::is_trivially_copyable_v<LapsResult>);
  int ends[2] = {};
  if (pipe(ends) != 0) return fail("no pipe to a process of its own");
  const pid_t child = fork();
  if (child < 0) return fail("no process of its own");
  if (child == 0) {
    const LapsResult result = drive(world, seed, closures);
    const bool told = write(ends[1], &result, sizeof result) == static_cast<ssize_t>(sizeof result);
    _exit(told ? 0 : 1);
  }
  close(ends[1]);
  LapsResult result;
  std::size_t got = 0;
  while (got < sizeof result) {
    const ssize_t n = read(ends[0], reinterpret_cast<char*>(&result) + got, sizeof result - got);
    if (n <= 0) break;
    got += static_cast<std::size_t>(n);
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return fail("the run's process was ended by signal {}", WTERMSIG(status));
  if (got < sizeof result) return fail("the run's process ended early");
  return result;
}

ExperimentPicture draw_growth(const std::string& world, const LapsResult& r) {
  Chart chart;
  chart.title = fmt::format("{}: the map after each lap", world);
  chart.x_label = "lap";
  chart.y_label = "patches";
  chart.y_from = 0.0;
  Series patches{"", {}, charts::robot_colour(0), Series::Look::line};
  Series dots{"", {}, charts::robot_colour(0), Series::Look::dots};
  for (std::size_t i = 0; i < r.laps.size(); ++i) {
    patches.points.emplace_back(static_cast<double>(i + 1), r.laps[i].patches);
  }
  dots.points = patches.points;
  chart.series = {patches, dots};
  chart.height = 300;
  return {world, draw_charts({chart})};
}

Outcome repeated(const LapsResult& r) {
  const LapRecord& second = r.laps[1];
  const LapRecord& last = r.laps[kLaps - 1];
  return {{{"patches_growth_percent", 100 * (last.patches / second.patches - 1)},
           {"map_growth_ratio", last.map_bytes / second.map_bytes},
           {"memory_growth_ratio", last.resident_bytes / second.resident_bytes},
           {"patches_count", last.patches},
           {"relations_count", last.relations},
           {"sheets_repeated_count", r.sheets},
           {"drift_m", r.drift_m},
           {"memory_mb", last.resident_bytes / 1048576},
           {"trajectory_per_scan_bytes", r.trajectory_bytes_per_scan}},
          {}};
}

Outcome spiral(const LapsResult& r) {
  return {{{"sheets_count", r.sheets},
           {"turn_relations_count", r.turn_relations},
           {"patches_count", r.laps[kLaps - 1].patches},
           {"drift_m", r.drift_m}},
          {}};
}

ExperimentCase make_case(const std::string& world_name, Outcome (*judge)(const LapsResult&), bool closures) {
  return {world_name, true, "", [=](std::uint64_t seed) -> Result<Outcome> {
            const Result<World> world = load_world(world_name);
            if (!world) return tl::unexpected(world.error());
            const Result<LapsResult> result = drive_alone(*world, seed, closures);
            if (!result) return tl::unexpected(result.error());
            Outcome outcome = judge(*result);
            if (seed == 1) outcome.pictures.push_back(draw_growth(world_name, *result));
            return outcome;
          }};
}

}  // namespace

Experiment laps_experiment() {
  Experiment e;
  e.name = "laps";
  e.question = "Does a robot that re-walks known ground add anything to the map?";
  e.method =
      "Ten laps with the default noise of laser and odometry, each run in a process of its own: out and back through a "
      "building without loops (branch), round one room (room), and round a loop corridor (loop) without closing the "
      "loop. "
      "In branch and room, growth is from the end of the second lap to the end of the tenth: of the number of patches, "
      "of "
      "the map's own bytes (patches, relations, poses) and of the process's resident memory, which holds the pose of "
      "every "
      "scan, too (less what the simulation keeps of the truth). In the loop corridor the uncertainty of a lap exceeds "
      "what patches of one sheet may have, so that "
      "each "
      "turn must lie on sheets of its own: no relation may join patches more than half a lap apart along the way.";
  e.bars = {{"patches_growth_percent", std::nullopt, 2.0, false},
            {"map_growth_ratio", std::nullopt, 1.05, false},
            {"memory_growth_ratio", std::nullopt, 1.05, false},
            {"sheets_count", 2.0, std::nullopt, false},
            {"turn_relations_count", std::nullopt, 0.0, false}};
  e.seeds = 20;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions&) {
    // Else what a run holds would depend on the thread that forked it.
    mallopt(M_ARENA_MAX, 1);
    return std::vector<ExperimentCase>{make_case("branch", repeated, true), make_case("room", repeated, true),
                                       make_case("loop", spiral, false)};
  };
  return e;
}

}  // namespace helicoid
