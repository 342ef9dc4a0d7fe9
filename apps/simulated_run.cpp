#include "apps/simulated_run.hpp"

#include "apps/map_run.hpp"
#include "helicoid/io/laser_file.hpp"
#include "helicoid/manifold/sheets.hpp"

namespace helicoid {

namespace {

constexpr std::size_t kScansInMost = std::size_t{1} << 16U;

/// The events of several days as one log: stamps and odometry go on where they ended the evening before.
class Days {
 public:
  Days(std::span<const World> worlds, const SimulationOptions& options)
      : worlds_(worlds), options_(options), evening_(static_cast<std::size_t>(options.robots)) {}

  Result<std::optional<SimulatedEvent>> next() {
    for (;;) {
      if (simulator_) {
        if (std::optional<SimulatedEvent> event = simulator_->next()) return continued(std::move(*event));
        simulator_.reset();
        ++day_;
      }
      if (day_ == worlds_.size()) return std::optional<SimulatedEvent>{};
      SimulationOptions today = options_;
      today.seed += 1000003 * day_;
      Result<Simulator> made = Simulator::make(worlds_[day_], today);
      if (!made) return tl::unexpected(made.error());
      simulator_ = std::move(*made);
      for (Evening& e : evening_) e.is_morning = true;
      night_ = last_stamp_;
    }
  }

 private:
  /// Where a robot truly stood and what its odometry said when it was last heard of.
  struct Evening {
    Pose2 T_world_robot, T_odom_robot;
    Pose2 T_odom_today;  ///< from today's odometry to that of all days
    bool is_morning = true;
  };

  SimulatedEvent continued(SimulatedEvent simulated) {
    Evening& e = evening_[simulated.event.robot.index()];
    if (day_ > 0) simulated.event.stamp += night_ - kFirstStamp + 1;
    simulated.lap += static_cast<int>(day_) * options_.laps;
    last_stamp_ = std::max(last_stamp_, simulated.event.stamp);
    if (auto* scan = std::get_if<Scan>(&simulated.event.body)) {
      if (day_ > 0 && e.is_morning) {
        const Pose2 T_then_now = e.T_world_robot.inverse() * simulated.T_world_robot;
        e.T_odom_today = e.T_odom_robot * T_then_now * scan->T_odom_robot.inverse();
      }
      e.is_morning = false;
      scan->T_odom_robot = e.T_odom_today * scan->T_odom_robot;
      e.T_odom_robot = scan->T_odom_robot;
      e.T_world_robot = simulated.T_world_robot;
    }
    return simulated;
  }

  static constexpr double kFirstStamp = 1000;  ///< of every simulation, seconds
  std::span<const World> worlds_;
  SimulationOptions options_;
  std::vector<Evening> evening_;
  std::optional<Simulator> simulator_;
  std::size_t day_ = 0;
  double last_stamp_ = 0, night_ = 0;
};

}  // namespace

Result<SimulatedRun> map_simulation(const World& world, const SimulationOptions& simulation,
                                    const MapperOptions& mapper, const SimulationObserver& observer,
                                    const SimulationFilter& filter) {
  return map_days({&world, 1}, simulation, mapper, observer, filter);
}

Result<SimulatedRun> map_days(std::span<const World> worlds, const SimulationOptions& simulation,
                              const MapperOptions& mapper, const SimulationObserver& observer,
                              const SimulationFilter& filter) {
  Days days(worlds, simulation);
  const Result<LaserModel> laser = load_laser("sick-lms200", simulated_lms200());
  if (!laser) return tl::unexpected(laser.error());
  SimulatedRun run{Mapper(mapper), {}, 0};
  for (std::size_t i = 0; i < static_cast<std::size_t>(simulation.robots); ++i) {
    run.mapper.add_robot(simulated_robot_name(i), {*laser});
    TrueTrack& track = run.tracks.emplace_back(TrueTrack{simulated_robot_name(i), {}, {}});
    // Room is taken at once: what a growing list leaves behind would be counted as the map's memory.
    track.stamps.reserve(kScansInMost);
    track.T_world_robot.reserve(kScansInMost);
  }
  for (;;) {
    const Result<std::optional<SimulatedEvent>> simulated = days.next();
    if (!simulated) return tl::unexpected(simulated.error());
    if (!*simulated) break;
    if (filter && !filter(**simulated, run.mapper)) continue;
    const Event& event = (*simulated)->event;
    const double before = thread_cpu_seconds();
    const Step step = run.mapper.process(event);
    run.cpu_s += thread_cpu_seconds() - before;
    if (std::holds_alternative<Scan>(event.body)) {
      TrueTrack& track = run.tracks[event.robot.index()];
      track.stamps.push_back(event.stamp);
      track.T_world_robot.push_back((*simulated)->T_world_robot);
    }
    if (observer) observer(**simulated, step, run.mapper);
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
