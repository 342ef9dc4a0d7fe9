// An empty room, exact sensors, and so many seconds of a live simulation: what its tests begin with.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <variant>
#include <vector>

#include "helicoid/simulation/live_simulation.hpp"

namespace helicoid {

/// An empty room of 10 x 6 m about the origin.
inline World box() {
  World world;
  world.name = "box";
  const Vector2d corners[] = {{-5, -3}, {5, -3}, {5, 3}, {-5, 3}};
  for (int i = 0; i < 4; ++i) world.walls.push_back({corners[i], corners[(i + 1) % 4]});
  return world;
}

inline LiveOptions exact() {
  LiveOptions options;
  options.laser_noise = LaserNoise::none();
  options.odometry_noise = OdometryNoise::none();
  options.sighting_noise = SightingNoise::none();
  return options;
}

inline LiveSimulation simulate(const World& world, const std::vector<LiveRobot>& robots,
                               const LiveOptions& options = exact()) {
  Result<LiveSimulation> simulation = LiveSimulation::make(world, robots, options);
  EXPECT_TRUE(simulation.has_value()) << simulation.error().message;
  return std::move(*simulation);
}

/// All events of so many seconds.
inline std::vector<LiveEvent> run(LiveSimulation& simulation, double seconds) {
  std::vector<LiveEvent> events;
  for (const double end = simulation.now() + seconds - 1e-6; simulation.now() < end;) {
    for (LiveEvent& event : simulation.tick()) events.push_back(std::move(event));
  }
  return events;
}

template <class Body>
std::vector<const Body*> bodies(const std::vector<LiveEvent>& events) {
  std::vector<const Body*> found;
  for (const LiveEvent& e : events) {
    if (const auto* body = std::get_if<Body>(&e.event.body)) found.push_back(body);
  }
  return found;
}

}  // namespace helicoid
