// Mapping whole logs, against trusting the odometry.
#include <filesystem>

#include "apps/bench.hpp"
#include "apps/evaluated_relations.hpp"
#include "apps/simulated_run.hpp"

namespace helicoid {

namespace {

constexpr double kLocalGap = 5;  // of the relations that are scored, seconds

double local_error(std::span<const EvaluatedTrajectory> poses, std::span<const EvaluatedRelation> relations) {
  RelationErrorOptions options;
  options.max_gap = kLocalGap;
  return relation_error(poses, relations, options).translation_m.mean;
}

/// The odometry of a log's scans, and what reading it costs.
struct OdometryRun {
  EvaluatedTrajectory trajectory;
  double seconds = 0;
};
Result<OdometryRun> read_odometry(const std::vector<RobotLogs>& robots) {
  OdometryRun run;
  const double before = thread_cpu_seconds();
  Result<MergedLogs> logs = MergedLogs::open(robots);
  if (!logs) return tl::unexpected(logs.error());
  while (const Event* event = logs->next()) {
    const auto* scan = std::get_if<Scan>(&event->body);
    if (scan == nullptr) continue;
    run.trajectory.stamps.push_back(event->stamp);
    run.trajectory.poses.push_back(scan->T_odom_robot);
  }
  run.seconds = thread_cpu_seconds() - before;
  return run;
}

BenchRow empty_row(const std::string& log) {
  BenchRow row;
  row.name = "map " + log;
  row.quality_unit = "m of local error";
  row.cost_unit = "us a scan";
  row.ours = {"helicoid", 0, 1e300};
  row.baseline = {"odometry", 0, 0};
  return row;
}

Result<BenchRow> map_recorded(const std::string& name, const std::string& log, const std::string& truth,
                              const BenchOptions& options) {
  const std::vector<RobotLogs> robots{{name, {log}}};
  std::vector<EvaluatedRelation> relations;
  if (!truth.empty()) {
    auto read = read_evaluated(truth);
    if (!read) return tl::unexpected(read.error());
    relations = std::move(*read);
  }
  const Result<OdometryRun> odometry = read_odometry(robots);
  if (!odometry) return tl::unexpected(odometry.error());
  const std::vector<EvaluatedTrajectory> raw{odometry->trajectory};
  BenchRow row = empty_row(name);
  if (truth.empty()) row.quality_unit = "(no truth)";
  row.baseline.quality = local_error(raw, relations);
  for (int i = 0; i < options.repeats; ++i) {
    MapJob job;
    job.robots = robots;
    const Result<MapRun> run = run_map(job);
    if (!run) return tl::unexpected(run.error());
    const auto scans = static_cast<double>(run->scans);
    const double us = 1e6 * (run->phase.read + run->phase.match + run->phase.fit) / scans;
    row.baseline.cost = 1e6 * odometry->seconds / scans;
    if (us >= row.ours.cost) continue;
    row.ours.quality = local_error(final_trajectories(run->mapper.map()), relations);
    row.ours.cost = us;
    row.note = fmt::format("{:.0f} scans/s; read {:.1f}, match {:.1f}, fit {:.1f} us; {} patches", 1e6 / us,
                           1e6 * run->phase.read / scans, 1e6 * run->phase.match / scans, 1e6 * run->phase.fit / scans,
                           run->mapper.map().patch_count());
  }
  return row;
}

Result<BenchRow> map_simulated(const std::string& name, const BenchOptions& options) {
  const Result<World> world = load_world(name);
  if (!world) return tl::unexpected(world.error());
  EvaluatedTrajectory odometry{simulated_robot_name(0), 0, {}, {}};
  BenchRow row = empty_row(name);
  for (int i = 0; i < options.repeats; ++i) {
    odometry.stamps.clear();
    odometry.poses.clear();
    const auto observe = [&](const SimulatedEvent& e, const Step&, const Mapper&) {
      if (const auto* scan = std::get_if<Scan>(&e.event.body)) {
        odometry.stamps.push_back(e.event.stamp);
        odometry.poses.push_back(scan->T_odom_robot);
      }
    };
    const Result<SimulatedRun> run = map_simulation(*world, {}, {}, observe);
    if (!run) return tl::unexpected(run.error());
    const double us = 1e6 * run->cpu_s / static_cast<double>(odometry.stamps.size());
    if (us >= row.ours.cost) continue;
    const std::vector<EvaluatedRelation> relations = true_relations(run->tracks, 1);
    const std::vector<EvaluatedTrajectory> raw{odometry};
    row.ours.quality = local_error(final_trajectories(run->map()), relations);
    row.ours.cost = us;
    row.baseline.quality = local_error(raw, relations);
    row.note = fmt::format("{:.0f} scans/s; {} patches", 1e6 / us, run->map().patch_count());
  }
  return row;
}

}  // namespace

std::vector<Benchmark> mapping_benchmarks(const BenchOptions& options) {
  std::vector<Benchmark> all;
  for (const char* name : {"office", "loop", "hall"}) {
    all.push_back({std::string("map ") + name, "", [=] { return map_simulated(name, options); }});
  }
  std::error_code error;
  for (const char* name : {"intel", "fr079", "csail"}) {
    const std::string base = options.data + "/" + name + "/" + name;
    const std::string truth = std::filesystem::exists(base + ".relations.gz", error) ? base + ".relations.gz" : "";
    const bool there = !options.data.empty() && std::filesystem::exists(base + ".clf.gz", error);
    all.push_back(
        {std::string("map ") + name,
         there ? "" : fmt::format("the recorded log {}/{}.clf.gz is not there; --data names its folder", name, name),
         [=] { return map_recorded(name, base + ".clf.gz", truth, options); }});
  }
  return all;
}

}  // namespace helicoid
