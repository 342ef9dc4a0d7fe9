// Is any wall drawn twice on one sheet?
#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/map_run.hpp"
#include "apps/sheet_crispness.hpp"
#include "apps/simulated_run.hpp"

namespace helicoid {

namespace {

Outcome measure(const Map& map) {
  const SheetCrispness all = crispness_by_sheet(map);
  const auto percent = [&](std::size_t cells) {
    return all.total.occupied > 0 ? 100.0 * static_cast<double>(cells) / static_cast<double>(all.total.occupied) : 0;
  };
  return {{{"twins_percent", percent(all.total.twins)},
           {"seen_at_once_percent", percent(all.total.seen_at_once)},
           {"occupied_cells", static_cast<double>(all.total.occupied)},
           {"sheets_count", static_cast<double>(all.sheets)},
           {"patches_count", static_cast<double>(map.patch_count())}},
          {}};
}

ExperimentCase recorded(const std::string& name, const ExperimentOptions& options) {
  const std::string log = fmt::format("{}/{}.clf.gz", name, name);
  ExperimentCase c{name, false, missing_data(options, log), {}};
  c.run = [name, log = options.data + "/" + log](std::uint64_t) -> Result<Outcome> {
    MapJob job;
    job.robots = {{name, {log}}};
    const Result<MapRun> run = run_map(job);
    if (!run) return tl::unexpected(run.error());
    return measure(run->mapper.map());
  };
  return c;
}

ExperimentCase simulated(const std::string& world_name) {
  return {world_name, true, "", [world_name](std::uint64_t seed) -> Result<Outcome> {
            const Result<World> world = load_world(world_name);
            if (!world) return tl::unexpected(world.error());
            SimulationOptions options;
            options.seed = seed;
            const Result<SimulatedRun> run = map_simulation(*world, options);
            if (!run) return tl::unexpected(run.error());
            return measure(run->map());
          }};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  for (const char* name : {"intel", "fr079", "csail"}) cases.push_back(recorded(name, options));
  for (const std::string& name : shipped_worlds()) cases.push_back(simulated(name));
  return cases;
}

}  // namespace

Experiment crispness_experiment() {
  Experiment e;
  e.name = "crispness";
  e.question = "Is any wall drawn twice on one sheet?";
  e.method =
      "Each log is mapped as it is, each shipped world after one drive with the default noise. On every sheet's "
      "occupancy "
      "grid (5 cm) the occupied cells are counted that have a parallel twin: another occupied cell 0.1-0.6 m away, "
      "straight "
      "along the surface's normal, whose surface faces the same way and runs beside the first for half a metre. A thin "
      "wall that is seen from the rooms on both its sides is no twin, since its surfaces face apart; a cupboard "
      "against a "
      "wall is none, since it hides the wall behind it. A wall and its copy face the same way, and the nearer one "
      "should "
      "have hidden the other. Two surfaces that a single scan shows at once (glass, legs of furniture, a door ajar) "
      "are "
      "both there, no twins, and counted apart. What moved between two visits counts: it cannot be told from a fault.";
  e.bars = {{"twins_percent", std::nullopt, 1.0, false}};
  e.seeds = 5;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
