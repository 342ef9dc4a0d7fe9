// Does a team that enters a building by two doors map it on its own? (Paper VI, fig. 6.)
#include <algorithm>
#include <iterator>

#include "apps/experiments/list.hpp"
#include "apps/explore_quality.hpp"
#include "apps/explore_run.hpp"
#include "apps/grid_picture.hpp"
#include "helicoid/charts/occupancy_grid.hpp"

namespace helicoid {

namespace {

constexpr std::size_t kRobots = 4;
constexpr double kOneDoor = 3;  // between starts at one door at most, metres

/// Accepted sightings of robots that began at different doors.
std::vector<Hypothesis> sightings_across(const World& world, const Mapper& mapper) {
  const auto start = [&](PatchId id) { return world.starts[mapper.map().patch(id).robot.index()].translation(); };
  std::vector<Hypothesis> across;
  std::copy_if(mapper.ledger().begin(), mapper.ledger().end(), std::back_inserter(across), [&](const Hypothesis& h) {
    return h.source == HypothesisSource::sighting && h.state == HypothesisState::accepted &&
           (start(h.a) - start(h.b)).norm() > kOneDoor;
  });
  return across;
}

/// Fig. 6 (c) and (d): the sketch of each island with its topological map.
void draw(const Map& map, const std::string& name, const std::string& remark,
          std::vector<ExperimentPicture>& pictures) {
  const MapReport report = report_on(map, true);
  for (std::size_t i = 0; i < report.islands.size(); ++i) {
    SketchDrawing drawing = draw_sketch(map, report, report.islands[i], 1);
    drawing.title = fmt::format("{}{}", fmt::join(report.islands[i].robots, ", "), remark);
    pictures.push_back({fmt::format("{}-{}", name, i + 1), to_svg(drawing)});
  }
}

/// Fig. 6 (b).
ExperimentPicture draw_grid_of(const Map& map) {
  const auto islands = map.islands();
  const std::vector<PatchId>& patches = islands.front().patches;
  GridFrameOptions options;
  options.resolution = 0.1;
  return {"grid", draw_grid(draw_occupancy(map, patches, frame_around(map, patches, options)))};
}

/// The same run once more, as far as the merge: the last moment of two islands, and the first of one.
Result<std::vector<ExperimentPicture>> draw_merge(const World& world, std::uint64_t seed, double merged_at) {
  std::vector<ExperimentPicture> pictures;
  ExploreJob job = explore_from_starts(world, kRobots, seed);
  job.observer = [&](double now, const LiveSimulation&, const TeamPilot& pilot, const SimulatedRecording&) {
    const Map& map = pilot.map();
    if (pictures.empty() && now + 1.5 * job.plan_period >= merged_at) draw(map, "before", "", pictures);
    if (now < merged_at) return true;
    const std::vector<Hypothesis> across = sightings_across(world, pilot.mapper());
    const auto name = [&](PatchId id) { return map.robot(map.patch(id).robot).name; };
    const std::string remark =
        across.empty() ? "" : fmt::format("; {} and {} have seen each other", name(across[0].a), name(across[0].b));
    draw(map, "merged", remark, pictures);
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

std::vector<Metric> metrics_of(const World& world, const Entered& entered, const MapQuality& quality) {
  const ExploreRun& run = entered.run;
  return {{"islands_before_count", static_cast<double>(entered.most_islands)},
          {"sightings_count", static_cast<double>(sightings_across(world, run.map.mapper).size())},
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
  Outcome outcome{metrics_of(*world, *entered, truth->judge(map, entered->run.recording.tracks())), {}};
  if (seed != 1) return outcome;
  Result<std::vector<ExperimentPicture>> merge = draw_merge(*world, seed, entered->merged_at);
  if (!merge) return tl::unexpected(merge.error());
  outcome.pictures = std::move(*merge);
  draw(map, "after", "", outcome.pictures);
  outcome.pictures.push_back(draw_grid_of(map));
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
      "simulation's own included. Sightings: of a robot of the other door. The pictures show the islands and the "
      "topological map before the merge, right after it and at the end, and the final occupancy grid.";
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
