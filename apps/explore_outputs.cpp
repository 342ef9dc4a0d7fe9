#include "apps/explore_outputs.hpp"

#include <cmath>

#include "apps/explore_quality.hpp"
#include "apps/map_summary.hpp"
#include "helicoid/base/whole_file.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double steps) {
  return std::round(steps * value) / steps;
}

Json frontiers_json(const Map& map, const TeamPlan& plan) {
  Json frontiers = Json::array();
  for (const FrontierLeft& f : plan.frontiers_left) {
    const Vector2d p_plane = project(map, f.middle);
    frontiers.push_back({{"island", map.island_of(f.middle.patch).value},
                         {"xy", {rounded(p_plane.x(), 1000), rounded(p_plane.y(), 1000)}},
                         {"length_m", rounded(f.length, 100)},
                         {"gain_m2", rounded(f.gain_m2, 100)},
                         {"reason", f.reason}});
  }
  return frontiers;
}

/// What `explore` says beyond what `map` does.
Json exploration_json(const ExploreRun& run, const MapQuality& quality) {
  const std::string area = fmt::format("{:.1f} of {:.1f} m2", quality.mapped_m2, quality.reachable_m2);
  return {{"end_state", run.end_state},
          {"reason", fmt::format("{} reachable; {}", area, run.reason)},
          {"reachable_m2", rounded(quality.reachable_m2, 100)},
          {"mapped_m2", rounded(quality.mapped_m2, 100)},
          {"mapped_fraction", rounded(quality.mapped_fraction, 1e5)},
          {"collisions", run.contacts.size()},
          {"merges", run.merges},
          {"operator_actions", run.operator_actions},
          {"sim_s", rounded(run.sim_s, 1000)},
          {"realtime_factor", rounded(run.realtime_factor(), 100)},
          {"wall_rms_m", rounded(quality.wall_rms_m, 1e4)},
          {"wall_recall", rounded(quality.wall_recall, 1e4)},
          {"frontiers_left", frontiers_json(run.map.mapper.map(), run.last_plan)},
          {"explore_cpu_s",
           {{"map", rounded(run.times.map_s, 1000)},
            {"floor", rounded(run.times.floor_s, 1000)},
            {"plan", rounded(run.times.plan_s, 1000)},
            {"steer", rounded(run.times.steer_s, 1000)},
            {"simulate", rounded(run.sim_cpu_s, 1000)}}}};
}

}  // namespace

Result<ExploreFiles> write_exploration(ExploreRun& run, const ExploreJob& job, const ExploreOutput& output) {
  std::vector<Pose2> starts;
  for (const LiveRobot& robot : job.robots) starts.push_back(robot.T_world_start);
  const Result<BuildingTruth> truth = BuildingTruth::of(job.world, starts, job.simulation.radius);
  if (!truth) return tl::unexpected(truth.error());
  const Map& map = run.map.mapper.map();
  const MapQuality quality = truth->judge(map, run.recording.tracks());
  const double before_charts = thread_cpu_seconds();
  const MapReport report = report_on(map, output.charts);
  ExploreFiles files;
  if (output.charts) {
    Result<std::vector<std::string>> charts = write_charts(map, report, output.folder, output.threads);
    if (!charts) return tl::unexpected(charts.error());
    files.pictures = std::move(*charts);
  }
  run.map.phase.charts = thread_cpu_seconds() - before_charts;
  if (auto done = run.recording.write(job.world, output.folder); !done) return tl::unexpected(done.error());
  if (auto done = write_records(run.map, output.folder, false); !done) return tl::unexpected(done.error());
  if (auto done = write_whole_file(output.folder + "/events.json", to_json(run.journal)); !done) {
    return tl::unexpected(done.error());
  }
  files.summary = summarise(run.map, report, output.options);
  files.summary["format"] = "helicoid-exploration-summary";
  files.summary.update(exploration_json(run, quality));
  if (auto done = write_whole_file(output.folder + "/summary.json", files.summary.dump(1) + "\n"); !done) {
    return tl::unexpected(done.error());
  }
  return files;
}

}  // namespace helicoid
