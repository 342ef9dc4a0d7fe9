#include <gmock/gmock.h>

#include <algorithm>

#include "tests/live_box.hpp"

namespace helicoid {
namespace {

/// Commands that wander about, a new one now and then.
void wander(LiveSimulation& simulation, Random& random) {
  for (std::size_t i = 0; i < simulation.robots(); ++i) {
    if (random.chance(0.1)) simulation.command(i, {random.uniform(-0.3, 0.8), random.uniform(-1.5, 1.5)});
  }
}

TEST(LiveSimulation, ARobotDrivesAsFastAsItsDriveLetsIt) {
  LiveSimulation simulation = simulate(box(), {{{-4, 0, 0}}});
  run(simulation, 0.1);
  simulation.command(0, {5, 0});
  Pose2 last = simulation.T_world_robot(0);
  double speed = 0;
  for (int k = 0; k < 50; ++k) {
    simulation.tick();
    const double now = (last.inverse() * simulation.T_world_robot(0)).distance() / 0.1;
    EXPECT_LE(now, 0.6 + 1e-9);
    EXPECT_LE(now - speed, 1.0 * 0.1 + 1e-9);
    speed = now;
    last = simulation.T_world_robot(0);
  }
  EXPECT_NEAR(speed, 0.6, 1e-9);
  simulation.command(0, {0, 0});
  run(simulation, 1);
  last = simulation.T_world_robot(0);
  run(simulation, 1);
  EXPECT_EQ(last, simulation.T_world_robot(0));
}

TEST(LiveSimulation, ACommandThatIsNotFiniteIsAStop) {
  LiveSimulation simulation = simulate(box(), {{{0, 0, 0}}});
  simulation.command(0, {std::nan(""), std::numeric_limits<double>::infinity()});
  run(simulation, 2);
  EXPECT_EQ(simulation.T_world_robot(0), (Pose2{0, 0, 0}));
}

TEST(LiveSimulation, ARobotThatDrivesAtAWallStopsAtItAndIsCountedOnce) {
  LiveSimulation simulation = simulate(box(), {{{3, 0, 0}}});
  simulation.command(0, {0.6, 0});
  run(simulation, 10);
  EXPECT_NEAR(simulation.T_world_robot(0).x, 5 - 0.2, 1e-4);
  EXPECT_LE(simulation.T_world_robot(0).x, 5 - 0.2);
  ASSERT_EQ(simulation.collisions(), 1U);
  EXPECT_EQ(simulation.contacts()[0].with, "wall");
  EXPECT_NEAR(simulation.contacts()[0].stamp, LiveSimulation::kFirstStamp + 1.8 / 0.6 + 0.3, 0.2);
}

TEST(LiveSimulation, WhoTouchesAWallCanTurnAndBackAwayAndTouchesAnewWhenItReturns) {
  LiveSimulation simulation = simulate(box(), {{{4.5, 0, 0}}});
  simulation.command(0, {0.6, 0});
  run(simulation, 3);
  simulation.command(0, {0, 1});
  run(simulation, 1);
  EXPECT_GT(simulation.T_world_robot(0).yaw, 0.5);
  EXPECT_EQ(simulation.collisions(), 1U);
  simulation.command(0, {-0.6, 0});
  run(simulation, 3);
  EXPECT_LT(simulation.T_world_robot(0).x, 4.2);
  simulation.command(0, {0.6, 0});
  run(simulation, 5);
  EXPECT_EQ(simulation.collisions(), 2U);
}

TEST(LiveSimulation, ADiscNeverOverlapsAWallOrAnotherOne) {
  const Result<World> world = load_world("office");
  std::vector<LiveRobot> robots;
  for (const Pose2& start : world->starts) robots.push_back({start});
  LiveOptions options = exact();
  options.people = 5;
  LiveSimulation simulation = simulate(*world, robots, options);
  const RayCaster walls(world->walls);
  Random random(11);
  for (int k = 0; k < 1500; ++k) {
    wander(simulation, random);
    simulation.tick();
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const Vector2d here = simulation.T_world_robot(i).translation();
      ASSERT_GE(walls.clearance(here, 100), options.radius);
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_GE((here - simulation.T_world_robot(j).translation()).norm(), 2 * options.radius);
      }
    }
  }
  EXPECT_GT(simulation.collisions(), 3U);
}

TEST(LiveSimulation, TwoRobotsThatDriveIntoEachOtherTouchOnce) {
  LiveSimulation simulation = simulate(box(), {{{-1, 0, 0}}, {{1, 0, radians(180)}}});
  simulation.command(0, {0.6, 0});
  simulation.command(1, {0.6, 0});
  run(simulation, 5);
  ASSERT_EQ(simulation.collisions(), 1U);
  EXPECT_THAT(simulation.contacts()[0].with, testing::StartsWith("robot"));
  const Vector2d between = simulation.T_world_robot(1).translation() - simulation.T_world_robot(0).translation();
  EXPECT_NEAR(between.norm(), 0.4, 1e-4);
}

TEST(LiveSimulation, PeopleNeverWalkIntoARobot) {
  LiveOptions options = exact();
  options.people = 15;
  LiveSimulation simulation = simulate(box(), {{{0, 0, 0}}, {{2, 1, 0}}}, options);
  run(simulation, 120);
  EXPECT_EQ(simulation.collisions(), 0U);
  std::size_t shortened = 0;
  const auto events = run(simulation, 1);
  for (const Scan* scan : bodies<Scan>(events)) {
    shortened += std::count_if(scan->ranges.begin(), scan->ranges.end(), [](float r) { return r < 2.5F; });
  }
  EXPECT_GT(shortened, 0U);
}

TEST(LiveSimulation, TheSameSeedAndCommandsGiveTheSameEvents) {
  const Result<World> world = load_world("office");
  std::vector<LiveRobot> robots;
  for (const Pose2& start : world->starts) robots.push_back({start});
  const auto record = [&](std::uint64_t seed) {
    LiveOptions options;
    options.seed = seed;
    options.people = 3;
    LiveSimulation simulation = simulate(*world, robots, options);
    Random random(5);
    std::vector<LiveEvent> events;
    for (int k = 0; k < 200; ++k) {
      wander(simulation, random);
      for (LiveEvent& event : simulation.tick()) events.push_back(std::move(event));
    }
    return events;
  };
  const auto first = record(1);
  const auto second = record(1);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].event.stamp, second[i].event.stamp);
    ASSERT_EQ(first[i].T_world_robot, second[i].T_world_robot);
    if (const auto* scan = std::get_if<Scan>(&first[i].event.body)) {
      ASSERT_EQ(scan->ranges, std::get<Scan>(second[i].event.body).ranges);
      ASSERT_EQ(scan->T_odom_robot, std::get<Scan>(second[i].event.body).T_odom_robot);
    }
  }
  EXPECT_NE(std::get<Scan>(record(2)[1].event.body).ranges, std::get<Scan>(first[1].event.body).ranges);
}

TEST(LiveSimulation, ARobotThatJoinsLateIsNotThereBefore) {
  LiveSimulation simulation = simulate(box(), {{{0, 0, 0}}, {{2, 0, 0}, 5}});
  for (const LiveEvent& e : run(simulation, 4.9)) {
    EXPECT_EQ(e.event.robot.value, 0U);
    const auto* scan = std::get_if<Scan>(&e.event.body);
    EXPECT_TRUE(scan == nullptr || std::abs(scan->ranges[90] - 5) < 1e-3F);
  }
  EXPECT_FALSE(simulation.alive(1));
  const auto events = run(simulation, 0.2);
  EXPECT_TRUE(simulation.alive(1));
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const LiveEvent& e) { return e.event.robot.value == 1; }));
}

TEST(LiveSimulation, ARobotWaitsWhileSomethingStandsOnItsStart) {
  LiveSimulation simulation = simulate(box(), {{{0, 0, 0}}, {{0.1, 0, 0}, 1}});
  run(simulation, 3);
  EXPECT_FALSE(simulation.alive(1));
  simulation.command(0, {-0.6, 0});
  run(simulation, 3);
  EXPECT_TRUE(simulation.alive(1));
  EXPECT_EQ(simulation.collisions(), 0U);
}

TEST(LiveSimulation, ADeadRobotIsSilentAndStandsInTheWay) {
  LiveSimulation simulation = simulate(box(), {{{0, 0, 0}}, {{2, 0, 0}, 0, 3}});
  simulation.command(1, {0.1, 0});
  run(simulation, 3);
  EXPECT_FALSE(simulation.alive(1));
  const Pose2 grave = simulation.T_world_robot(1);
  EXPECT_GT(grave.x, 2.2);
  simulation.command(0, {0.6, 0});
  for (const LiveEvent& e : run(simulation, 6)) EXPECT_EQ(e.event.robot.value, 0U);
  EXPECT_EQ(simulation.T_world_robot(1), grave);
  EXPECT_NEAR(simulation.T_world_robot(0).x, grave.x - 0.4, 1e-3);
  EXPECT_EQ(simulation.collisions(), 1U);
}

TEST(LiveSimulation, RefusesStartsWhereNoRobotFits) {
  EXPECT_FALSE(LiveSimulation::make(box(), {}, {}).has_value());
  const auto at_a_wall = LiveSimulation::make(box(), {{{4.9, 0, 0}}}, {});
  ASSERT_FALSE(at_a_wall.has_value());
  EXPECT_THAT(at_a_wall.error().message, testing::HasSubstr("start 1"));
  EXPECT_FALSE(LiveSimulation::make(box(), {{{0, 0, 0}}, {{0.3, 0, 0}}}, {}).has_value());
  EXPECT_TRUE(LiveSimulation::make(box(), {{{0, 0, 0}}, {{0.3, 0, 0}, 60}}, {}).has_value());
}

TEST(LiveSimulation, ARobotWhoseBatteryIsEmptyStandsThereSilent) {
  LiveOptions options = exact();
  options.metres_per_charge = 2;
  LiveSimulation simulation = simulate(box(), {{{-4, 0, 0}}, {{-4, 2, 0}}}, options);
  simulation.command(0, {0.5, 0});
  EXPECT_EQ(simulation.battery(0), 1);
  std::ignore = run(simulation, 2);
  EXPECT_GT(simulation.battery(0), 0.4);
  EXPECT_LT(simulation.battery(0), 0.8);
  EXPECT_TRUE(simulation.alive(0));
  std::ignore = run(simulation, 4);
  EXPECT_EQ(simulation.battery(0), 0);
  EXPECT_FALSE(simulation.alive(0));
  EXPECT_TRUE(simulation.alive(1));
  EXPECT_NEAR(simulation.T_world_robot(0).x, -2, 0.06);
  for (const LiveEvent& e : run(simulation, 2)) EXPECT_EQ(e.event.robot.index(), 1U);
}

}  // namespace
}  // namespace helicoid
