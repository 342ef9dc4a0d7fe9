// Does a team that enters a building by two doors map it on its own? (Paper VI, fig. 6.)
#include <algorithm>
#include <memory>

#include "apps/experiments/list.hpp"
#include "apps/explore_quality.hpp"
#include "apps/explore_run.hpp"

namespace helicoid {

namespace {

constexpr std::size_t kRobots = 4;

/// Fig. 6 (c) and (d): the sketch of each island with its topological map.
void draw(const Map& map, const std::string& name, std::vector<ExperimentPicture>& pictures) {
  const MapReport report = report_on(map, true);
  for (std::size_t i = 0; i < report.islands.size(); ++i) {
    SketchDrawing drawing = draw_sketch(map, report, report.islands[i], 1);
    drawing.title = fmt::format("{}", fmt::join(report.islands[i].robots, ", "));
    pictures.push_back({fmt::format("{}-{}", name, i + 1), to_svg(drawing)});
  }
}

/// The same run once more, up to the last moment of two islands.
Result<std::vector<ExperimentPicture>> draw_before(const World& world, std::uint64_t seed, double merged_at) {
  std::vector<ExperimentPicture> pictures;
  ExploreJob job = explore_from_starts(world, kRobots, seed);
  job.observer = [&](double now, const LiveSimulation&, const TeamPilot& pilot, const SimulatedRecording&) {
    if (now + 1.5 * job.plan_period < merged_at) return true;
    draw(pilot.map(), "before", pictures);
    return false;
  };
  const Result<ExploreRun> run = run_exploration(job);
  if (!run) return tl::unexpected(run.error());
  return pictures;
}

/// A run and when its islands were joined.
struct Entered {
  ExploreRun run;
  std::size_t most_islands = 0;  ///< after the robots of either door have seen each other
  double merged_at = 0;          ///< seconds
};

Result<Entered> enter(const World& world, std::uint64_t seed) {
  constexpr double kAtDoor = 30;  // seconds
  std::size_t most_islands = 0;
  double merged_at = 0;
  ExploreJob job = explore_from_starts(world, kRobots, seed);
  job.observer = [&](double now, const LiveSimulation&, const TeamPilot& pilot, const SimulatedRecording&) {
    const std::size_t islands = pilot.map().islands().size();
    if (now > kAtDoor) most_islands = std::max(most_islands, islands);
    if (islands == 1 && merged_at == 0) merged_at = now;
    return true;
  };
  Result<ExploreRun> run = run_exploration(job);
  if (!run) return tl::unexpected(run.error());
  return Entered{std::move(*run), most_islands, merged_at};
}

std::vector<Metric> metrics_of(const Entered& entered, const MapQuality& quality) {
  const ExploreRun& run = entered.run;
  const Ledger& ledger = run.map.mapper.ledger();
  const auto sightings = std::count_if(ledger.begin(), ledger.end(), [](const Hypothesis& h) {
    return h.source == HypothesisSource::sighting && h.state == HypothesisState::accepted;
  });
  return {{"islands_before_count", static_cast<double>(entered.most_islands)},
          {"sightings_count", static_cast<double>(sightings)},
          {"merges_count", static_cast<double>(run.merges)},
          {"islands_after_count", static_cast<double>(run.map.mapper.map().islands().size())},
          {"explored_count", run.last_plan.end_state == EndState::explored ? 1.0 : 0.0},
          {"mapped_percent", 100 * quality.mapped_fraction},
          {"operator_actions_count", static_cast<double>(run.operator_actions)},
          {"collisions_count", static_cast<double>(run.contacts.size())},
          {"realtime_ratio", run.realtime_factor()},
          {"wall_rms_m", quality.wall_rms_m},
          {"wall_recall_percent", 100 * quality.wall_recall},
          {"merged_at_s", entered.merged_at},
          {"explored_s", run.sim_s}};
}

Result<Outcome> explore_by_two_doors(std::uint64_t seed) {
  const Result<World> world = load_world("office");
  if (!world) return tl::unexpected(world.error());
  const Result<Entered> entered = enter(*world, seed);
  if (!entered) return tl::unexpected(entered.error());
  const Result<BuildingTruth> truth =
      BuildingTruth::of(*world, std::span(world->starts).first(kRobots), LiveOptions{}.radius);
  if (!truth) return tl::unexpected(truth.error());
  const Map& map = entered->run.map.mapper.map();
  Outcome outcome{metrics_of(*entered, truth->judge(map, entered->run.recording.tracks())), {}};
  if (seed != 1) return outcome;
  Result<std::vector<ExperimentPicture>> before = draw_before(*world, seed, entered->merged_at);
  if (!before) return tl::unexpected(before.error());
  outcome.pictures = std::move(*before);
  draw(map, "after", outcome.pictures);
  return outcome;
}

}  // namespace

Experiment fig6_experiment() {
  Experiment e;
  e.name = "fig6";
  e.question = "Does a team that enters a building by two doors map it on its own?";
  e.method =
      "The paper's figure 6: four robots explore an office of about 600 square metres, two from each of two doors "
      "whose relative pose nobody knows. Robots of one door see each other at once; then there are two islands, until "
      "somebody sees somebody of the other door. Mapped: of the floor that a robot can reach. Walls: from all occupied "
      "cells to the true walls after one rigid alignment, RMS, and the share of the walls in view that have an "
      "occupied cell within 10 cm. Collisions are any contact. Real time: seconds in the building for one of CPU, the "
      "simulation's own included. The pictures show the islands and the topological map before and after the merge.";
  e.bars = {{"islands_before_count", 2.0, 2.0, false},
            {"sightings_count", 1.0, std::nullopt, false},
            {"merges_count", 1.0, 1.0, false},
            {"islands_after_count", 1.0, 1.0, false},
            {"explored_count", 1.0, std::nullopt, false},
            {"mapped_percent", 99.0, std::nullopt, false},
            {"operator_actions_count", std::nullopt, 0.0, false},
            {"collisions_count", std::nullopt, 0.0, false},
            {"realtime_ratio", 1.0, std::nullopt, false, true},
            {"wall_rms_m", std::nullopt, 0.05, false},
            {"wall_recall_percent", 97.0, std::nullopt, false}};
  e.seeds = 10;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions&) {
    return std::vector<ExperimentCase>{
        {"office", true, "", [](std::uint64_t seed) { return explore_by_two_doors(seed); }}};
  };
  return e;
}

}  // namespace helicoid
