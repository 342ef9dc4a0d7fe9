// What robots that are driven report of where they are and of what they see.
#include <gmock/gmock.h>

#include "tests/live_box.hpp"

namespace helicoid {
namespace {

TEST(LiveSensors, EveryRobotScansOnceATickAndStampsAscend) {
  LiveSimulation simulation = simulate(box(), {{{-1, 0, 0}}, {{1, 0, 0}}, {{2, 0, 0}}});
  double last = 0;
  for (int k = 0; k < 20; ++k) {
    const auto events = simulation.tick();
    EXPECT_EQ(bodies<Scan>(events).size(), 3U);
    EXPECT_EQ(bodies<Odometry>(events).size(), 3U);
    for (const LiveEvent& e : events) {
      EXPECT_GE(e.event.stamp, last);
      last = e.event.stamp;
    }
    EXPECT_LT(last, LiveSimulation::kFirstStamp + simulation.now() + 0.1);
  }
}

TEST(LiveSensors, ARobotSeesAnotherAsADisc) {
  LiveSimulation simulation = simulate(box(), {{{0, 0, 0}}, {{2, 0, 0}}});
  const auto events = run(simulation, 0.1);
  const Scan* scan = bodies<Scan>(events)[0];
  EXPECT_NEAR(scan->ranges[90], 1.8, 1e-3);
}

TEST(LiveSensors, SightingsTellTheTruthWithinRangeViewAndLineOfSight) {
  World world = box();
  world.walls.push_back({{0, -3}, {0, 1}});
  LiveOptions options = exact();
  options.sighting_range = 5;
  // The second is behind the partition, the third in sight of the first, which looks away from the fourth.
  const std::vector<LiveRobot> robots{{{-2, 0, 0}}, {{2, -1, 0}}, {{-1, 1, 1.5}}, {{-3, 0, radians(180)}}};
  LiveSimulation simulation = simulate(world, robots, options);
  std::vector<std::string> seen_by_first;
  for (const LiveEvent& e : run(simulation, 0.95)) {
    const auto* sighting = std::get_if<Sighting>(&e.event.body);
    if (sighting == nullptr || e.event.robot.value != 0) continue;
    seen_by_first.push_back(sighting->observed);
    const Pose2 T_first_third = robots[0].T_world_start.inverse() * robots[2].T_world_start;
    EXPECT_NEAR(*sighting->range, T_first_third.distance(), 1e-9);
    EXPECT_NEAR(*sighting->bearing, std::atan2(T_first_third.y, T_first_third.x), 1e-9);
    EXPECT_NEAR(*sighting->orientation, 1.5, 1e-9);
  }
  EXPECT_THAT(seen_by_first, testing::ElementsAre("robot3"));
}

TEST(LiveSensors, OdometryWithoutNoiseIsTheTrueMotion) {
  LiveSimulation simulation = simulate(box(), {{{-1, 0.5, 0.3}}});
  Random random(4);
  std::vector<LiveEvent> events;
  for (int k = 0; k < 300 && simulation.collisions() == 0; ++k) {
    for (LiveEvent& event : simulation.tick()) {
      if (simulation.collisions() == 0) events.push_back(std::move(event));
    }
    simulation.command(0, {random.uniform(-0.6, 0.6), random.uniform(-1, 1)});
  }
  ASSERT_GT(events.size(), 200U);
  for (const LiveEvent& e : events) {
    const auto* odometry = std::get_if<Odometry>(&e.event.body);
    if (odometry == nullptr) continue;
    const Pose2 error = e.T_world_robot.inverse() * (Pose2{-1, 0.5, 0.3} * odometry->T_odom_robot);
    ASSERT_LT(error.distance() + std::abs(error.yaw), 1e-9);
  }
}

TEST(LiveSensors, WheelsSlipAtAWallAndOdometryGoesOnCounting) {
  LiveSimulation simulation = simulate(box(), {{{4, 0, 0}}});
  simulation.command(0, {0.6, 0});
  const auto events = run(simulation, 10);
  EXPECT_NEAR(bodies<Odometry>(events).back()->T_odom_robot.x, 10 * 0.6, 0.3);
}

}  // namespace
}  // namespace helicoid
