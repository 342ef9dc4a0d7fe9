// A live simulation that is mapped as it runs: for experiments in which robots drive on what they have mapped.
#pragma once

#include <span>
#include <vector>

#include "helicoid/mapping/mapper.hpp"
#include "helicoid/simulation/live_simulation.hpp"

namespace helicoid {

class LiveMapping {
 public:
  /// Error: as LiveSimulation::make has it.
  [[nodiscard]] static Result<LiveMapping> make(const World& world, std::vector<LiveRobot> robots,
                                                const LiveOptions& options, const MapperOptions& mapper);
  /// The same again, to the bit: what was heard so far goes into a new mapper.
  [[nodiscard]] LiveMapping again() const;

  void command(std::size_t robot, const DriveCommand& command) { simulation_.command(robot, command); }
  /// One period of the simulation, and the mapper's steps.
  void tick();

  [[nodiscard]] const LiveSimulation& simulation() const { return simulation_; }
  [[nodiscard]] const Mapper& mapper() const { return mapper_; }
  [[nodiscard]] const Map& map() const { return mapper_.map(); }
  /// Of a robot's latest scan.
  [[nodiscard]] const Scan& scan(std::size_t robot) const { return scans_[robot]; }
  /// Where that was taken; a robot that has not scanned yet has no patch.
  [[nodiscard]] const ManifoldPose& pose(std::size_t robot) const { return poses_[robot]; }
  /// Where each of a robot's scans was truly taken, as map().robot(id).trajectory has them.
  [[nodiscard]] std::span<const Pose2> truth(std::size_t robot) const { return truth_[robot]; }

 private:
  LiveMapping(LiveSimulation simulation, const MapperOptions& mapper);
  void hear(const Event& event);

  MapperOptions mapper_options_;
  LiveSimulation simulation_;
  Mapper mapper_;
  std::vector<Event> heard_;
  std::vector<Scan> scans_;
  std::vector<ManifoldPose> poses_;
  std::vector<std::vector<Pose2>> truth_;
};

}  // namespace helicoid
