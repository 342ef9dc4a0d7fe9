// Does one sighting collapse the spirals of two robots that never saw each other? (Paper IV-B.)
#include <algorithm>
#include <cmath>

#include "apps/experiments/list.hpp"
#include "apps/map_run.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/manifold/sheets.hpp"

namespace helicoid {

namespace {

constexpr int kTurns = 5;
constexpr int kLaps = 10;
/// Patches of two laps show the same walls if they stand this near, metres.
constexpr double kSamePlace = 1.5;

/// CPU seconds of the mapper by robot and lap.
using LapCosts = std::vector<std::vector<double>>;

struct Spirals {
  SimulatedRun run;
  std::vector<std::vector<int>> lap_of_scan;  ///< by robot
  LapCosts lap_cpu_s;
  int least_sheets_before = 0;  ///< of either island when the sighting came
  double collapse_cpu_s = 0;
};

int most_sheets(const Map& map) {
  const std::vector<int> sheets = count_sheets(map);
  return *std::max_element(sheets.begin(), sheets.end());
}

int least_sheets(const Map& map) {
  const std::vector<int> sheets = count_sheets(map);
  return *std::min_element(sheets.begin(), sheets.end());
}

SimulationOptions lapping(int robots, int laps, std::uint64_t seed) {
  SimulationOptions options;
  options.robots = robots;
  options.laps = laps;
  options.seed = seed;
  options.alternate = true;
  options.sightings = robots > 1;
  return options;
}

/// Robots drive their laps; of their sightings only the first after the given number of laps of each is heard.
Result<Spirals> drive(const std::string& world_name, int robots, int laps, int heard_after, std::uint64_t seed,
                      const MapperOptions& mapper) {
  const Result<World> world = load_world(world_name);
  if (!world) return tl::unexpected(world.error());
  const auto count = static_cast<std::size_t>(robots);
  Spirals s{{Mapper(mapper), {}, 0}, std::vector<std::vector<int>>(count), LapCosts(count), 0, 0};
  bool heard = false;
  std::vector<int> lap(count, 0);
  bool joined = false;
  double before = 0;
  const auto hears = [&](const SimulatedEvent& simulated, const Mapper& mapping) {
    lap[simulated.event.robot.index()] = simulated.lap;
    if (std::holds_alternative<Sighting>(simulated.event.body)) {
      if (heard || *std::min_element(lap.begin(), lap.end()) < heard_after) return false;
      heard = true;
      s.least_sheets_before = least_sheets(mapping.map());
    }
    before = thread_cpu_seconds();
    return true;
  };
  const auto observe = [&](const SimulatedEvent& simulated, const Step&, const Mapper& mapping) {
    const double cpu_s = thread_cpu_seconds() - before;
    const std::size_t robot = simulated.event.robot.index();
    if (std::holds_alternative<Scan>(simulated.event.body)) s.lap_of_scan[robot].push_back(simulated.lap);
    // Islands are counted while it matters only: that goes through all of the map, and costs the next scan its cache.
    if (heard && !joined && mapping.map().islands().size() == 1) {
      joined = true;
      s.collapse_cpu_s = cpu_s;
      return;
    }
    std::vector<double>& costs = s.lap_cpu_s[robot];
    costs.resize(std::max(costs.size(), static_cast<std::size_t>(simulated.lap) + 1));
    costs[static_cast<std::size_t>(simulated.lap)] += cpu_s;
  };
  Result<SimulatedRun> run = map_simulation(*world, lapping(robots, laps, seed), mapper, observe, hears);
  if (!run) return tl::unexpected(run.error());
  s.run = std::move(*run);
  return s;
}

/// Overlapping pairs of patches that are known relative to each other, of all that overlap, in percent.
double related_percent(const Map& map) {
  const auto count = [](const Neighbours& neighbours) {
    std::size_t pairs = 0;
    for (const std::vector<PatchId>& of_patch : neighbours) pairs += of_patch.size();
    return static_cast<double>(pairs);
  };
  const double overlapping = count(find_neighbours(map, {1e9, 1e9}));
  return overlapping > 0 ? 100 * count(find_neighbours(map)) / overlapping : 0;
}

/// How far the walls that patches of two laps or robots show at one place lie apart from one another: RMS over the
/// points of either scan, across the wall, for no other reason than the patches' poses.
double walls_rms(const Spirals& s) {
  const Map& map = s.run.map();
  const auto lap = [&](PatchId id) {
    const Patch& patch = map.patch(id);
    return std::pair(patch.robot, s.lap_of_scan[patch.robot.index()][patch.scan_index]);
  };
  double sum = 0;
  std::size_t points = 0;
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const PatchId a = make_id<PatchId>(j);
      const PatchId b = make_id<PatchId>(i);
      const Pose2 T_a_b_true = s.run.T_world_patch(a).inverse() * s.run.T_world_patch(b);
      if (T_a_b_true.distance() > kSamePlace || lap(a) == lap(b)) continue;
      const Pose2 T_a_b = map.T_plane_patch(a).inverse() * map.T_plane_patch(b);
      const ScanPoints& scan = map.patch(b).points;
      for (std::size_t k = 0; k < scan.size(); ++k) {
        const Vector2d p(scan.x[k], scan.y[k]);
        const Vector2d normal = T_a_b_true.rotation() * Vector2d(scan.nx[k], scan.ny[k]);
        const double off = normal.dot(T_a_b * p - T_a_b_true * p);
        sum += off * off;
        ++points;
      }
    }
  }
  return points > 0 ? std::sqrt(sum / static_cast<double>(points)) : std::numeric_limits<double>::quiet_NaN();
}

Result<Outcome> collapse(const std::string& world, std::uint64_t seed) {
  MapperOptions mapper;
  mapper.look_alikes = false;
  const Result<Spirals> s = drive(world, 2, kTurns + 1, kTurns, seed, mapper);
  if (!s) return tl::unexpected(s.error());
  const Map& map = s->run.map();
  double first = 0;
  double after = 0;
  for (const std::vector<double>& cpu_s : s->lap_cpu_s) {
    first += cpu_s.front();
    after += cpu_s[kTurns];
  }
  return Outcome{{{"spiral_sheets_count", static_cast<double>(s->least_sheets_before)},
                  {"islands_count", static_cast<double>(map.islands().size())},
                  {"sheets_count", static_cast<double>(most_sheets(map))},
                  {"related_percent", related_percent(map)},
                  {"walls_rms_m", walls_rms(*s)},
                  {"collapse_cpu_s", s->collapse_cpu_s},
                  {"after_collapse_cost_ratio", after / first},
                  {"patches_count", static_cast<double>(map.patch_count())}},
                 {}};
}

Result<Outcome> close_every_lap(const std::string& world, std::uint64_t seed) {
  const Result<Spirals> s = drive(world, 1, kLaps, 0, seed, {});
  if (!s) return tl::unexpected(s.error());
  const Map& map = s->run.map();
  std::vector<double> patches(kLaps, 0);
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const int lap = s->lap_of_scan[0][map.patch(make_id<PatchId>(i)).scan_index];
    for (std::size_t k = static_cast<std::size_t>(lap); k < patches.size(); ++k) ++patches[k];
  }
  const std::vector<double>& cpu_s = s->lap_cpu_s[0];
  double later = 0;
  for (std::size_t lap = 2; lap < cpu_s.size(); ++lap) later += cpu_s[lap] / static_cast<double>(cpu_s.size() - 2);
  return Outcome{{{"sheets_count", static_cast<double>(most_sheets(map))},
                  {"patches_growth_percent", 100 * (patches.back() / patches[1] - 1)},
                  {"later_laps_cost_ratio", later / cpu_s.front()},
                  {"laps_related_percent", related_percent(map)},
                  {"walls_rms_m", walls_rms(*s)},
                  {"patches_count", patches.back()}},
                 {}};
}

}  // namespace

Experiment spiral_experiment() {
  Experiment e;
  e.name = "spiral";
  e.question = "Does one sighting collapse the spirals of two robots that never saw each other?";
  e.method =
      "The paper's own figure (IV-B): two robots circle a loop corridor in opposite directions five times each without "
      "seeing each other or comparing places, so that either map winds up into a spiral; then one sighting is heard. "
      "What it collapses to, at what cost (CPU of that one event), and what a sixth lap costs beside the first. Walls: "
      "those that patches of different laps or robots show at one place, across the wall, RMS. And one robot that may "
      "close its loops whenever it likes: ten laps, growth from the end of the second, cost of laps three to ten "
      "beside lap one.";
  e.bars = {{"spiral_sheets_count", 5.0, std::nullopt, false},
            {"islands_count", std::nullopt, 1.0, false},
            {"sheets_count", std::nullopt, 1.0, false},
            {"related_percent", 100.0, std::nullopt, false},
            {"walls_rms_m", std::nullopt, 0.03, false},
            {"collapse_cpu_s", std::nullopt, 1.0, false, true},
            {"after_collapse_cost_ratio", std::nullopt, 1.05, true, true},
            {"patches_growth_percent", std::nullopt, 2.0, false},
            {"later_laps_cost_ratio", std::nullopt, 1.05, true, true}};
  e.seeds = 10;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions&) {
    return std::vector<ExperimentCase>{
        {"collapse", true, "", [](std::uint64_t seed) { return collapse("loop", seed); }},
        {"every-lap", true, "", [](std::uint64_t seed) { return close_every_lap("loop", seed); }}};
  };
  return e;
}

}  // namespace helicoid
