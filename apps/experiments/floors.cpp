// Are two floors of one plan ever taken for one?
#include <algorithm>

#include "apps/experiments/list.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/mapping/loop_closer.hpp"
#include "helicoid/simulation/buildings.hpp"

namespace helicoid {

namespace {

/// From so many pieces on that stand elsewhere, of 204, evidence must not join the floors.
constexpr std::size_t kEnough = 16;
constexpr double kApart = 300;  // metres: no laser reaches from floor to floor

/// Both floors side by side, each with a robot's route. The upper one differs from the lower in `moved` pieces.
World two_floors(std::uint64_t seed, std::size_t moved) {
  World both = make_hospital(seed);
  const World upper = make_hospital(seed, moved);
  const Vector2d aside(kApart, 0);
  for (const Segment& wall : upper.walls) both.walls.push_back({wall.from + aside, wall.to + aside});
  Route route = upper.routes.front();
  for (Vector2d& point : route.points) point += aside;
  both.routes.push_back(std::move(route));
  return both;
}

struct FloorCase {
  const char* name;
  bool on_evidence;
  std::size_t moved;
  int people;  ///< who walk about
  bool quick;  ///< part of the short form
};
constexpr FloorCase kCases[] = {{"default-0", false, 0, 0, true},         {"default-64", false, 64, 0, false},
                                {"evidence-0", true, 0, 0, true},         {"evidence-1", true, 1, 0, false},
                                {"evidence-2", true, 2, 0, false},        {"evidence-4", true, 4, 0, false},
                                {"evidence-8", true, 8, 0, false},        {"evidence-16", true, 16, 0, true},
                                {"evidence-32", true, 32, 0, false},      {"evidence-64", true, 64, 0, false},
                                {"evidence-0-people", true, 0, 8, false}, {"evidence-16-people", true, 16, 8, false}};

Result<Outcome> map_floors(const FloorCase& c, std::uint64_t seed) {
  SimulationOptions simulation;
  simulation.robots = 2;
  simulation.seed = seed;
  simulation.sightings = true;
  simulation.people = c.people;
  MapperOptions mapper;
  mapper.join_on_evidence = c.on_evidence;
  const Result<SimulatedRun> run = map_simulation(two_floors(seed, c.moved), simulation, mapper);
  if (!run) return tl::unexpected(run.error());
  const double joined = run->map().islands().size() < 2 ? 1 : 0;
  const Ledger& ledger = run->mapper.ledger();
  double proposals = 0;
  double contradicted = 0;
  for (const Hypothesis& h : ledger) {
    if (run->map().patch(h.a).robot == run->map().patch(h.b).robot) continue;
    ++proposals;
    contradicted += is_left_open(h) ? 1 : 0;
  }
  const bool judged = !c.on_evidence || c.moved >= kEnough;
  return Outcome{{{judged ? "wrong_joins_count" : "joins_of_alike_floors_count", joined},
                  {"moved_pieces_count", static_cast<double>(c.moved)},
                  {"proposals_count", proposals},
                  {"refused_count", contradicted},
                  {"cpu_s", run->cpu_s}},
                 {}};
}

}  // namespace

Experiment floors_experiment() {
  Experiment e;
  e.name = "floors";
  e.question = "Are two floors of one plan ever taken for one?";
  e.method = fmt::format(
      "Two floors of a hospital ward: the same walls and doors, 204 pieces of furniture from one seed, of which on the "
      "upper floor some stand elsewhere in their rooms. A robot on each sees every third room from inside; no sighting "
      "is possible. By default, and with --join evidence; twice with eight people who walk about. A floor that does "
      "not differ where robots saw it cannot be told from the other, and the same logs would come from one floor on "
      "which "
      "so many pieces were moved between two visits: what evidence makes of fewer than {} pieces is reported, not "
      "judged. A proposal is an entry of the ledger between the floors; refused are those that agreed until all the "
      "ground that both robots know was laid over one another.",
      kEnough);
  e.bars = {{"wrong_joins_count", std::nullopt, 0.0, false}};
  e.seeds = 5;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions& options) {
    std::vector<ExperimentCase> cases;
    for (const FloorCase& c : kCases) {
      if (options.quick && !c.quick) continue;
      cases.push_back({c.name, true, "", [&c](std::uint64_t seed) { return map_floors(c, seed); }});
    }
    return cases;
  };
  return e;
}

}  // namespace helicoid
