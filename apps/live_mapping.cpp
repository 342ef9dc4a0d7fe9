#include "apps/live_mapping.hpp"

#include "helicoid/io/laser_file.hpp"
#include "helicoid/simulation/simulator.hpp"

namespace helicoid {

LiveMapping::LiveMapping(LiveSimulation simulation, const MapperOptions& mapper)
    : mapper_options_(mapper),
      simulation_(std::move(simulation)),
      mapper_(mapper),
      scans_(simulation_.robots()),
      poses_(simulation_.robots()),
      truth_(simulation_.robots()) {}

Result<LiveMapping> LiveMapping::make(const World& world, std::vector<LiveRobot> robots, const LiveOptions& options,
                                      const MapperOptions& mapper) {
  Result<LiveSimulation> simulation = LiveSimulation::make(world, std::move(robots), options);
  if (!simulation) return tl::unexpected(simulation.error());
  const Result<LaserModel> laser = load_laser("sick-lms200", simulation->laser());
  if (!laser) return tl::unexpected(laser.error());
  LiveMapping mapping(std::move(*simulation), mapper);
  for (std::size_t i = 0; i < mapping.simulation_.robots(); ++i) {
    mapping.mapper_.add_robot(simulated_robot_name(i), {*laser});
  }
  return mapping;
}

LiveMapping LiveMapping::again() const {
  LiveMapping copy(simulation_, mapper_options_);
  for (const RobotRecord& robot : map().robots()) copy.mapper_.add_robot(robot.name, robot.lasers);
  for (const Event& event : heard_) copy.hear(event);
  copy.truth_ = truth_;
  return copy;
}

void LiveMapping::hear(const Event& event) {
  const Step step = mapper_.process(event);
  heard_.push_back(event);
  const auto* scan = std::get_if<Scan>(&event.body);
  if (scan == nullptr) return;
  scans_[event.robot.index()] = *scan;
  poses_[event.robot.index()] = step.pose;
}

void LiveMapping::tick() {
  for (const LiveEvent& live : simulation_.tick()) {
    if (std::holds_alternative<Scan>(live.event.body)) {
      truth_[live.event.robot.index()].push_back(live.T_world_robot);
    }
    hear(live.event);
  }
}

}  // namespace helicoid
