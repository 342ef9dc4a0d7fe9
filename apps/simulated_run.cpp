#include "apps/simulated_run.hpp"

#include "apps/map_run.hpp"
#include "helicoid/io/laser_file.hpp"
#include "helicoid/manifold/sheets.hpp"

namespace helicoid {

namespace {

constexpr std::size_t kScansInMost = std::size_t{1} << 16U;

}  // namespace

Result<SimulatedRun> map_simulation(const World& world, const SimulationOptions& simulation,
                                    const MapperOptions& mapper, const SimulationObserver& observer,
                                    const SimulationFilter& filter) {
  Result<Simulator> simulator = Simulator::make(world, simulation);
  if (!simulator) return tl::unexpected(simulator.error());
  const Result<LaserModel> laser = load_laser("sick-lms200", simulator->laser());
  if (!laser) return tl::unexpected(laser.error());
  SimulatedRun run{Mapper(mapper), {}, 0};
  for (std::size_t i = 0; i < static_cast<std::size_t>(simulation.robots); ++i) {
    run.mapper.add_robot(simulated_robot_name(i), {*laser});
    TrueTrack& track = run.tracks.emplace_back(TrueTrack{simulated_robot_name(i), {}, {}});
    // Room is taken at once: what a growing list leaves behind would be counted as the map's memory.
    track.stamps.reserve(kScansInMost);
    track.T_world_robot.reserve(kScansInMost);
  }
  while (const std::optional<SimulatedEvent> simulated = simulator->next()) {
    if (filter && !filter(*simulated, run.mapper)) continue;
    const double before = thread_cpu_seconds();
    const Step step = run.mapper.process(simulated->event);
    run.cpu_s += thread_cpu_seconds() - before;
    if (std::holds_alternative<Scan>(simulated->event.body)) {
      TrueTrack& track = run.tracks[simulated->event.robot.index()];
      track.stamps.push_back(simulated->event.stamp);
      track.T_world_robot.push_back(simulated->T_world_robot);
    }
    if (observer) observer(*simulated, step, run.mapper);
  }
  const double before = thread_cpu_seconds();
  run.mapper.finish();
  run.cpu_s += thread_cpu_seconds() - before;
  return run;
}

std::vector<int> count_sheets(const Map& map) {
  const Neighbours neighbours = find_neighbours(map);
  std::vector<int> sheets;
  for (const Island& island : map.islands()) sheets.push_back(count_sheets(map, neighbours, island));
  return sheets;
}

std::vector<EvaluatedRelation> true_relations(std::span<const TrueTrack> tracks, std::uint64_t seed) {
  std::vector<EvaluatedRelation> relations;
  for (const ScanPair& p : choose_true_relations(tracks, seed)) {
    const TrueTrack& a = tracks[p.robot_a];
    const TrueTrack& b = tracks[p.robot_b];
    relations.push_back({a.robot, a.stamps[p.scan_a], b.robot, b.stamps[p.scan_b],
                         a.T_world_robot[p.scan_a].inverse() * b.T_world_robot[p.scan_b]});
  }
  return relations;
}

std::vector<EvaluatedTrajectory> final_trajectories(const Map& map) {
  std::vector<EvaluatedTrajectory> trajectories;
  for (const RobotRecord& robot : map.robots()) {
    EvaluatedTrajectory trajectory{robot.name, 0, {}, {}};
    for (const TrackedScan& scan : robot.trajectory) {
      trajectory.frame = static_cast<int>(map.island_of(scan.pose.patch).value);
      trajectory.stamps.push_back(scan.stamp);
      trajectory.poses.push_back(map.project(scan.pose));
    }
    trajectories.push_back(std::move(trajectory));
  }
  return trajectories;
}

RelationError relation_error(const SimulatedRun& run, std::uint64_t seed, const RelationErrorOptions& options) {
  return relation_error(final_trajectories(run.map()), true_relations(run.tracks, seed), options);
}

}  // namespace helicoid
