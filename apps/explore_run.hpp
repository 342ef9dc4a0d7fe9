// A team explores a simulated building on its own: the loop that the paper's robots are in.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/map_run.hpp"
#include "apps/order_effect.hpp"
#include "apps/simulated_recording.hpp"
#include "apps/team_pilot.hpp"
#include "helicoid/simulation/radio.hpp"

namespace helicoid {

struct ExploreJob {
  World world;
  std::vector<LiveRobot> robots;
  LiveOptions simulation;
  PilotOptions pilot;
  /// Without it everybody is always heard. Who is out of contact goes on by itself, with a map of its own.
  std::optional<RadioOptions> radio;
  TeamPilot::Planner planner;  ///< empty: the explorer
  double plan_period = 1;      ///< seconds
  double longest = 3600;       ///< then it is over whatever is left, simulated seconds
  /// Asked before every plan what an operator has said since the last one.
  std::function<std::vector<Order>(double now, const Map&)> orders;
  /// Told after every plan; false: it is over.
  std::function<bool(double now, const LiveSimulation&, const TeamPilot&, const SimulatedRecording&)> observer;
};

struct ExploreRun {
  ExploreRun(Mapper mapper, SimulatedRecording robots) : recording(std::move(robots)) {
    map.mapper = std::move(mapper);
  }
  MapRun map;                        ///< with a radio: of the events by their stamps, as a map of the logs
  std::optional<OrderEffect> order;  ///< with a radio: what it does that events came late and in bulk
  SimulatedRecording recording;
  ExploreJournal journal;
  TeamPlan last_plan;
  std::string end_state;
  std::string reason;
  std::vector<LiveSimulation::Contact> contacts;
  /// Joins of islands whose robots began apart. Those that begin side by side see each other in the first seconds.
  std::size_t merges = 0;
  std::size_t operator_actions = 0;
  double sim_s = 0;      ///< simulated seconds
  double sim_cpu_s = 0;  ///< CPU seconds of the simulation itself: no robot needs them
  double cpu_s = 0;      ///< CPU seconds of all else
  PilotTimes times;
  [[nodiscard]] double realtime_factor() const { return sim_s / (cpu_s + sim_cpu_s); }
};

/// Robots at the first of a world's own starts, of which there are enough.
[[nodiscard]] ExploreJob explore_from_starts(const World& world, std::size_t robots, std::uint64_t seed);

/// Explores until the team has come to an end, then fits the map once more. The same job, the same run, to the bit.
/// Errors: a robot that cannot start where it should.
[[nodiscard]] Result<ExploreRun> run_exploration(const ExploreJob& job);

}  // namespace helicoid
