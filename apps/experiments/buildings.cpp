// Is the program, as it is, as good in buildings that nobody looked at while it was written?
#include "helicoid/simulation/buildings.hpp"

#include "apps/evaluated_relations.hpp"
#include "apps/experiments/false_closures.hpp"
#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/map_run.hpp"
#include "apps/sheet_crispness.hpp"
#include "apps/simulated_run.hpp"
#include "apps/world_picture.hpp"

namespace helicoid {

namespace {

struct Building {
  const char* name;
  int laps;      ///< a day
  int people;    ///< who walk about
  double noise;  ///< of the odometry, times what a good base has
  std::vector<World> (*days)(std::uint64_t seed);
};

template <World (*make)(std::uint64_t)>
std::vector<World> same_every_day(std::uint64_t seed) {
  return {make(seed)};
}

/// Of 204 pieces a quarter stand elsewhere on the second day.
std::vector<World> hospital_days(std::uint64_t seed) {
  return {make_hospital(seed), make_hospital(seed, 50)};
}

constexpr Building kBuildings[] = {{"hospital", 1, 0, 1, hospital_days},
                                   {"hospital-people-odometry-3", 1, 8, 3, hospital_days},
                                   {"terminal", 1, 0, 1, same_every_day<make_terminal>},
                                   {"terminal-odometry-3", 1, 0, 3, same_every_day<make_terminal>},
                                   {"warehouse", 2, 0, 1, same_every_day<make_warehouse>},
                                   {"dormitory", 1, 0, 1, same_every_day<make_dormitory>},
                                   {"rotunda", 2, 0, 1, same_every_day<make_rotunda>}};

/// What is not as the program takes it to be: factors.
struct Variation {
  const char* name;
  double eps = 1;       ///< the limits of eq. 12
  double laser = 1;     ///< the laser's noise; of a recorded log what it is taken to be
  double odometry = 1;  ///< the odometry's
};
constexpr Variation kNone{""};
constexpr Variation kVariations[] = {{"-eps-less", 0.7},
                                     {"-eps-more", 1.3},
                                     {"-laser-less", 1, 0.7},
                                     {"-laser-more", 1, 1.3},
                                     {"-odometry-less", 1, 1, 0.7},
                                     {"-odometry-more", 1, 1, 1.3}};

MapperOptions mapper_options(const Variation& variation) {
  MapperOptions options;
  options.reference_position *= variation.eps;
  options.reference_heading *= variation.eps;
  return options;
}

struct Judged {
  double accepted = 0, wrong = 0;
};

Judged judge_closures(const SimulatedRun& run) {
  Judged judged;
  for (const Hypothesis& h : run.mapper.ledger()) {
    if (h.state != HypothesisState::accepted) continue;
    ++judged.accepted;
    judged.wrong += is_false(run, h) ? 1 : 0;
  }
  return judged;
}

Result<Outcome> map_building(const Building& building, const Variation& variation, std::uint64_t seed) {
  const std::vector<World> days = building.days(seed);
  SimulationOptions options;
  options.seed = seed;
  options.laps = building.laps;
  options.people = building.people;
  options.laser_noise = scaled(options.laser_noise, variation.laser);
  options.odometry_noise = scaled(options.odometry_noise, building.noise * variation.odometry);
  const Result<SimulatedRun> run = map_days(days, options, mapper_options(variation));
  if (!run) return tl::unexpected(run.error());
  const RelationError error = relation_error(*run, seed);
  const Judged closures = judge_closures(*run);
  const SheetCrispness crispness = crispness_by_sheet(run->map());
  Outcome outcome{{{"error_mean_m", error.translation_m.mean},
                   {"error_max_m", error.translation_m.max},
                   {"error_mean_deg", error.rotation_deg.mean},
                   {"false_closures_count", closures.wrong},
                   {"closures_count", closures.accepted},
                   {"sheets_count", static_cast<double>(crispness.sheets)},
                   {"twins_percent", 100 * crispness.total.share},
                   {"patches_count", static_cast<double>(run->map().patch_count())},
                   {"scans_count", static_cast<double>(run->tracks[0].stamps.size())},
                   {"cpu_s", run->cpu_s}},
                  {}};
  const bool is_first = seed == 1 && building.noise == 1 && variation.name == kNone.name;
  if (is_first) outcome.pictures.push_back({building.name, draw_world(days[0], run->tracks)});
  return outcome;
}

/// A recorded log. Its sensors are what they are, and its odometry's noise is learned: what the program takes its laser
/// to be can be another.
Result<Outcome> map_log(const std::string& folder, const std::string& name, const Variation& variation) {
  MapJob job;
  job.robots = {{name, {fmt::format("{}/{}.clf.gz", folder, name)}}};
  job.laser_noise = variation.laser;
  job.mapper = mapper_options(variation);
  const Result<MapRun> run = run_map(job);
  if (!run) return tl::unexpected(run.error());
  const auto known = read_evaluated(fmt::format("{}/{}.relations.gz", folder, name));
  if (!known) return tl::unexpected(known.error());
  const RelationError error = relation_error(final_trajectories(run->mapper.map()), *known);
  return Outcome{{{"error_mean_m", error.translation_m.mean},
                  {"error_max_m", error.translation_m.max},
                  {"error_mean_deg", error.rotation_deg.mean},
                  {"patches_count", static_cast<double>(run->mapper.map().patch_count())}},
                 {}};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  for (const Building& building : kBuildings) {
    cases.push_back({building.name, true, "", [=](std::uint64_t seed) { return map_building(building, kNone, seed); }});
  }
  if (options.quick) return cases;
  for (const Variation& v : kVariations) {
    for (const Building& building : kBuildings) {
      if (building.noise > 1) continue;
      cases.push_back({fmt::format("{}{}", building.name, v.name), false, "",
                       [=](std::uint64_t seed) { return map_building(building, v, seed); }});
    }
  }
  for (const std::string name : {"intel", "fr079"}) {
    const std::string folder = options.data + "/" + name;
    for (const Variation& v : {kNone, kVariations[0], kVariations[1], kVariations[2], kVariations[3]}) {
      cases.push_back(
          {name + v.name, false, missing_data(options, name), [=](std::uint64_t) { return map_log(folder, name, v); }});
    }
  }
  return cases;
}

}  // namespace

Experiment buildings_experiment() {
  Experiment e;
  e.name = "buildings";
  e.question = "Is the program, as it is, as good in buildings that nobody looked at while it was written?";
  e.method =
      "Five buildings made by rule, from the seed: a hospital ward of 50 like rooms on a ring corridor, in which a "
      "quarter of the furniture stands elsewhere on the second day; corridors of 250 m in loops of 620 m; a hall with "
      "rows of like racks; a corridor between 32 rooms that are furnished all alike; a round corridor with one across. "
      "Twice with three times the odometry's noise and, in the ward, eight people who walk about. No option is given. "
      "Then how robust that is, once each: the limits of what counts as known (eq. 12's eps) 30 % less and more, and "
      "laser and odometry 30 % better and worse than the program takes them to be; recorded logs with eps, and the "
      "laser that the program takes them to have, less and more. "
      "Errors are of scans a moment apart and of scans at one place after half a minute or more. A closure is false if "
      "it is off by more than 0.5 m or 0.15 rad and by more than it says itself (99 %): along a bare corridor an entry "
      "may "
      "say nothing.";
  e.bars = {{"error_mean_m", std::nullopt, 0.033, true},
            {"error_max_m", std::nullopt, 0.4, false},
            {"false_closures_count", std::nullopt, 0.0, false},
            {"twins_percent", std::nullopt, 1.0, false}};
  e.seeds = 5;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
