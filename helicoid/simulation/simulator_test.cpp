#include "helicoid/simulation/simulator.hpp"

#include <gtest/gtest.h>

#include <map>

namespace helicoid {
namespace {

/// An empty room of 10 x 6 m about the origin with a square route.
World box() {
  World world;
  world.name = "box";
  const Vector2d corners[] = {{-5, -3}, {5, -3}, {5, 3}, {-5, 3}};
  for (int i = 0; i < 4; ++i) world.walls.push_back({corners[i], corners[(i + 1) % 4]});
  world.routes.push_back({{{-3, -1.5}, {3, -1.5}, {3, 1.5}, {-3, 1.5}}, true});
  return world;
}

SimulationOptions exact() {
  SimulationOptions options;
  options.laser_noise = LaserNoise::none();
  options.odometry_noise = OdometryNoise::none();
  return options;
}

std::vector<SimulatedEvent> run(const World& world, const SimulationOptions& options) {
  Result<Simulator> simulator = Simulator::make(world, options);
  EXPECT_TRUE(simulator.has_value());
  std::vector<SimulatedEvent> events;
  while (auto event = simulator->next()) events.push_back(std::move(*event));
  return events;
}

const Scan* scan_of(const SimulatedEvent& e) {
  return std::get_if<Scan>(&e.event.body);
}

/// What a beam inside the box measures.
double range_in_box(const Vector2d& from, double bearing) {
  const auto reach = [](double at, double direction, double half) {
    return direction == 0 ? INFINITY : ((direction > 0 ? half : -half) - at) / direction;
  };
  return std::min(reach(from.x(), std::cos(bearing), 5), reach(from.y(), std::sin(bearing), 3));
}

TEST(Simulator, NoiseFreeRangesAreTheAnalyticOnes) {
  int scans = 0;
  for (const SimulatedEvent& e : run(box(), exact())) {
    const Scan* scan = scan_of(e);
    if (scan == nullptr) continue;
    ++scans;
    for (int beam = 0; beam < 180; ++beam) {
      const double bearing = e.T_world_robot.yaw + radians(beam - 90);
      ASSERT_NEAR(scan->ranges[static_cast<std::size_t>(beam)], range_in_box(e.T_world_robot.translation(), bearing),
                  1e-5);
    }
  }
  EXPECT_GT(scans, 100);
}

TEST(Simulator, NoiseFreeOdometryIsTheTrueMotion) {
  const auto events = run(box(), exact());
  const Pose2 T_world_odom = events.front().T_world_robot;
  for (const SimulatedEvent& e : events) {
    const auto* odometry = std::get_if<Odometry>(&e.event.body);
    if (odometry == nullptr) continue;
    const Pose2 error = e.T_world_robot.inverse() * (T_world_odom * odometry->T_odom_robot);
    ASSERT_LT(error.distance() + std::abs(error.yaw), 1e-9);
  }
}

TEST(Simulator, TheSameSeedGivesTheSameEvents) {
  SimulationOptions options;
  options.robots = 2;
  options.people = 3;
  options.sightings = true;
  const auto first = run(box(), options);
  const auto second = run(box(), options);
  ASSERT_EQ(first.size(), second.size());
  bool differs_by_seed = false;
  options.seed = 2;
  const auto other = run(box(), options);
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].event.stamp, second[i].event.stamp);
    ASSERT_EQ(first[i].T_world_robot, second[i].T_world_robot);
    if (const Scan* scan = scan_of(first[i])) {
      ASSERT_EQ(scan->ranges, scan_of(second[i])->ranges);
      ASSERT_EQ(scan->T_odom_robot, scan_of(second[i])->T_odom_robot);
      const Scan* another = i < other.size() ? scan_of(other[i]) : nullptr;
      differs_by_seed = differs_by_seed || (another != nullptr && another->ranges != scan->ranges);
    }
  }
  EXPECT_TRUE(differs_by_seed);
}

TEST(Simulator, NoRobotTouchesAWallInAShippedWorld) {
  for (const std::string& name : shipped_worlds()) {
    const Result<World> world = load_world(name);
    const RayCaster walls(world->walls);
    SimulationOptions options = exact();
    options.scan_period = 5;
    for (const SimulatedEvent& e : run(*world, options)) {
      ASSERT_GT(walls.clearance(e.T_world_robot.translation(), 100), 0.22)
          << name << " at " << e.T_world_robot.x << ", " << e.T_world_robot.y;
    }
  }
}

TEST(Simulator, RobotsThatMeetInACorridorPassOneAnother) {
  const Result<World> world = load_world("loop");
  const RayCaster walls(world->walls);
  SimulationOptions options = exact();
  options.robots = 2;
  options.alternate = true;
  options.scan_period = 5;
  Result<Simulator> simulator = Simulator::make(*world, options);
  while (const auto event = simulator->next()) {
    ASSERT_GT(walls.clearance(event->T_world_robot.translation(), 100), 0.22);
  }
  EXPECT_GT(simulator->closest_approach(), 0.44);
  EXPECT_LT(simulator->closest_approach(), 2);
}

TEST(Simulator, RobotsThatMeetAllFinishTheirLaps) {
  for (const char* name : {"office", "branch", "room"}) {
    const Result<World> world = load_world(name);
    for (const int robots : {2, 3, 5, 8}) {
      SimulationOptions options = exact();
      options.robots = robots;
      options.alternate = true;
      options.scan_period = 5;
      Result<Simulator> simulator = Simulator::make(*world, options);
      double last = 0;
      while (const auto event = simulator->next()) {
        last = event->event.stamp - 1000;
        ASSERT_LT(last, 3000) << robots << " robots in " << name << ": nobody gets on";
      }
      EXPECT_GT(last, 20);
    }
  }
}

TEST(Simulator, LapsEndWhereTheyBegan) {
  for (const char* name : {"room", "branch"}) {
    const Result<World> world = load_world(name);
    SimulationOptions options = exact();
    options.scan_period = 5;
    options.laps = 2;
    std::map<int, Pose2> ends;
    for (const SimulatedEvent& e : run(*world, options)) ends[e.lap] = e.T_world_robot;
    ASSERT_GE(ends.size(), 2U) << name;
    EXPECT_LT((ends[0].inverse() * ends[1]).distance(), 0.1) << name;
  }
}

TEST(Simulator, RangeErrorsHaveTheirStandardDeviation) {
  SimulationOptions options = exact();
  options.laser_noise.range_sigma = 0.02;
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (const SimulatedEvent& e : run(box(), options)) {
    const Scan* scan = scan_of(e);
    if (scan == nullptr) continue;
    for (int beam = 0; beam < 180; ++beam) {
      const double truth = range_in_box(e.T_world_robot.translation(), e.T_world_robot.yaw + radians(beam - 90));
      const double error = static_cast<double>(scan->ranges[static_cast<std::size_t>(beam)]) - truth;
      sum += error;
      squares += error * error;
      count += 1;
    }
  }
  EXPECT_NEAR(sum / count, 0, 4 * 0.02 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.02 * 4 / std::sqrt(2 * count));
}

TEST(Simulator, HeadingDriftsByTheSquareRootOfTheWay) {
  // The heading's variance after a straight way of length s is drift_sigma^2 s.
  World world = box();
  world.routes = {{{{-4, 0}, {4, 0}}, false}};
  double squares = 0;
  constexpr int kSeeds = 400;
  double way = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    SimulationOptions options = exact();
    options.seed = static_cast<std::uint64_t>(seed);
    options.odometry_noise.drift_sigma = 0.02;
    options.scan_period = 100;
    Result<Simulator> simulator = Simulator::make(world, options);
    while (auto event = simulator->next()) {
      const auto* odometry = std::get_if<Odometry>(&event->event.body);
      if (odometry == nullptr || event->T_world_robot.x < 3) continue;
      way = event->T_world_robot.x + 4;
      squares += std::pow(wrap_angle(odometry->T_odom_robot.yaw - event->T_world_robot.yaw), 2);
      break;
    }
  }
  const double expected = 0.02 * 0.02 * way;
  EXPECT_NEAR(squares / kSeeds, expected, 4 * expected * std::sqrt(2.0 / kSeeds));
}

TEST(Simulator, RobotsAreSeenInOneAnothersScans) {
  SimulationOptions options = exact();
  options.robots = 2;
  std::size_t seen = 0;
  for (const SimulatedEvent& e : run(box(), options)) {
    const Scan* scan = scan_of(e);
    if (scan == nullptr) continue;
    for (int beam = 0; beam < 180; ++beam) {
      const double wall = range_in_box(e.T_world_robot.translation(), e.T_world_robot.yaw + radians(beam - 90));
      const auto range = static_cast<double>(scan->ranges[static_cast<std::size_t>(beam)]);
      ASSERT_LT(range, wall + 1e-5);
      if (range < wall - 0.3) ++seen;
    }
  }
  EXPECT_GT(seen, 100U);
}

TEST(Simulator, SightingsTellTheTruthWithinRangeAndLineOfSight) {
  World world = box();
  world.walls.push_back({{0, -3}, {0, 1}});  // a partition with a way round its end
  world.routes = {{{{-3, 2}, {3, 2}, {3, -2}, {3, 2}, {-3, 2}, {-3, -2}}, true}};
  SimulationOptions options = exact();
  options.robots = 2;
  options.laps = 3;
  options.sightings = true;
  options.sighting_range = 5;
  options.sighting_noise = SightingNoise::none();
  const RayCaster walls(world.walls);
  std::map<std::uint32_t, Pose2> at;
  int sightings = 0;
  for (const SimulatedEvent& e : run(world, options)) {
    at[e.event.robot.value] = e.T_world_robot;
    const auto* sighting = std::get_if<Sighting>(&e.event.body);
    if (sighting == nullptr) continue;
    ++sightings;
    EXPECT_EQ(sighting->observed, simulated_robot_name(1 - e.event.robot.index()));
    EXPECT_LE(*sighting->range, 5);
    EXPECT_LE(std::abs(*sighting->bearing), radians(90));
    const Vector2d direction(std::cos(e.T_world_robot.yaw + *sighting->bearing),
                             std::sin(e.T_world_robot.yaw + *sighting->bearing));
    EXPECT_EQ(walls.cast(e.T_world_robot.translation(), direction, *sighting->range).segment, -1);
    // The other robot may have moved one tick since its last event.
    const Vector2d there = e.T_world_robot.translation() + *sighting->range * direction;
    EXPECT_LT((there - at[1 - e.event.robot.value].translation()).norm(), 0.06);
  }
  EXPECT_GT(sightings, 5);
}

TEST(Simulator, PeopleStayInsideAndOutOfFurniture) {
  const Result<World> world = load_world("room");
  SimulationOptions options = exact();
  options.people = 10;
  std::size_t shortened = 0;
  const RayCaster walls(world->walls);
  for (const SimulatedEvent& e : run(*world, options)) {
    const Scan* scan = scan_of(e);
    if (scan == nullptr) continue;
    for (int beam = 0; beam < 180; ++beam) {
      const double bearing = e.T_world_robot.yaw + radians(beam - 90);
      const double wall =
          walls.cast(e.T_world_robot.translation(), {std::cos(bearing), std::sin(bearing)}, 80).distance;
      const auto range = static_cast<double>(scan->ranges[static_cast<std::size_t>(beam)]);
      ASSERT_LT(range, wall + 1e-5);
      if (range < wall - 1e-3) ++shortened;
    }
  }
  EXPECT_GT(shortened, 1000U);
}

TEST(Simulator, AWorldWithoutARouteSaysWhatIsMissing) {
  World world = box();
  world.routes.clear();
  const Result<Simulator> simulator = Simulator::make(world, {});
  ASSERT_FALSE(simulator.has_value());
  EXPECT_NE(simulator.error().message.find("route"), std::string::npos);
}

}  // namespace
}  // namespace helicoid
