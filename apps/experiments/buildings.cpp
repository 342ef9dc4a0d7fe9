// Is the program, as it is, as good in buildings that nobody looked at while it was written?
#include "helicoid/simulation/buildings.hpp"

#include <cmath>

#include "apps/experiments/list.hpp"
#include "apps/sheet_crispness.hpp"
#include "apps/simulated_run.hpp"
#include "apps/world_picture.hpp"

namespace helicoid {

namespace {

/// An entry of the ledger that is off by more than this is false.
constexpr double kFalseBy = 0.5;       // metres
constexpr double kFalseByTurn = 0.15;  // radians

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

struct Judged {
  double accepted = 0, wrong = 0;
};

Judged judge_closures(const SimulatedRun& run) {
  Judged judged;
  for (const Hypothesis& h : run.mapper.ledger()) {
    if (h.state != HypothesisState::accepted) continue;
    ++judged.accepted;
    const Pose2 truth = run.T_world_patch(h.a).inverse() * run.T_world_patch(h.b);
    const Pose2 off = truth.inverse() * h.T_a_b.T_a_b;
    if (off.distance() > kFalseBy || std::abs(off.yaw) > kFalseByTurn) ++judged.wrong;
  }
  return judged;
}

Result<Outcome> map_building(const Building& building, std::uint64_t seed) {
  const std::vector<World> days = building.days(seed);
  SimulationOptions options;
  options.seed = seed;
  options.laps = building.laps;
  options.people = building.people;
  options.odometry_noise = scaled(options.odometry_noise, building.noise);
  const Result<SimulatedRun> run = map_days(days, options);
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
  if (seed == 1 && building.noise == 1) outcome.pictures.push_back({building.name, draw_world(days[0], run->tracks)});
  return outcome;
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
      "Errors are of scans a moment apart and of scans at one place after half a minute or more. A closure is false if "
      "it is off by more than 0.5 m or 0.15 rad.";
  e.bars = {{"error_mean_m", std::nullopt, 0.033, true},
            {"error_max_m", std::nullopt, 0.4, false},
            {"false_closures_count", std::nullopt, 0.0, false},
            {"twins_percent", std::nullopt, 1.0, false}};
  e.seeds = 5;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions&) {
    std::vector<ExperimentCase> cases;
    for (const Building& building : kBuildings) {
      cases.push_back({building.name, true, "", [=](std::uint64_t seed) { return map_building(building, seed); }});
    }
    return cases;
  };
  return e;
}

}  // namespace helicoid
