#include "helicoid/navigation/route_follower.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/synthetic_floor.hpp"

namespace helicoid {
namespace {

using synthetic::corridor;
using synthetic::Driver;
using synthetic::Floor;
using synthetic::outline;
using synthetic::two_rooms;
using synthetic::Wall;

TEST(RouteFollower, ArrivesWithoutTouchingThroughADoor) {
  Random random(2);
  for (int round = 0; round < 10; ++round) {
    Floor floor = two_rooms();
    floor.send({random.uniform(0.5, 4), random.uniform(0.5, 4.5), random.uniform(-3, 3)},
               {random.uniform(10, 11.5), random.uniform(0.5, 4.5)});
    const double length = floor.drivers[0].follower.route().length;
    EXPECT_LT(floor.run(100), 10 + 2 * length / 0.6) << "round " << round;
    EXPECT_EQ(floor.drivers[0].step.status, FollowStatus::arrived);
    EXPECT_GE(floor.drivers[0].closest, 0.22) << "round " << round;
  }
}

TEST(RouteFollower, TurnsToTheHeadingThatItIsToldAtTheEnd) {
  Floor floor = two_rooms();
  floor.send({1, 1, 0}, {3, 1});
  // On whatever patch near by it is told: a route ends on the patch that suits it.
  for (const PatchId patch : floor.builder.patches()) {
    const ManifoldRoute route = floor.drivers[0].follower.route();
    floor.drivers[0].follower.follow(
        route, ManifoldHeading{patch, wrap_angle(2.5 - floor.builder.map.T_plane_patch(patch).yaw)});
    floor.run(30);
    EXPECT_NEAR(floor.drivers[0].T_plane_robot.yaw, 2.5, 0.12);
  }
}

TEST(RouteFollower, IsIdleWithoutARoute) {
  Floor floor = two_rooms();
  floor.drivers.push_back({{1, 1, 0}, RouteFollower{}});
  floor.tick();
  EXPECT_EQ(floor.drivers[0].step.status, FollowStatus::idle);
  EXPECT_EQ(floor.drivers[0].step.command, DriveCommand{});
}

TEST(RouteFollower, StepsRoundWhatIsNotInTheMap) {
  Floor floor = corridor(2.4);
  floor.send({1, 1.2, 0}, {13, 1.2});
  floor.unknown = outline({6, 1.3}, 0.3);
  EXPECT_LT(floor.run(90), 60);
  EXPECT_GE(floor.drivers[0].closest, 0.21);
}

TEST(RouteFollower, LeavesWhatItStandsTooNearToPassStraightAhead) {
  Floor floor = corridor(2);
  floor.send({5, 1, 0}, {10, 1});
  // Beside the robot and a hand's breadth ahead: 0.25 m off now, 0.23 m when it would pass.
  floor.unknown = outline({5.12, 1.43}, 0.2);
  EXPECT_LT(floor.run(40), 20);
  EXPECT_GE(floor.drivers[0].closest, 0.21);
}

TEST(RouteFollower, StepsOffACornerThatItStandsTooNearToPass) {
  Random random(6);
  for (int round = 0; round < 60; ++round) {
    Floor floor = corridor(1.3);
    floor.send({5, 0.65, 0}, {10, 0.65});
    // Most ways on would bring it nearer still.
    const double side = round % 2 == 0 ? -1 : 1;
    const double bearing = random.uniform(0.5, 1.5);
    const Vector2d corner = random.uniform(0.212, 0.224) * Vector2d(std::cos(bearing), side * std::sin(bearing));
    const double x = 5 + corner.x();
    const double y = 0.65 + corner.y();
    floor.unknown = synthetic::rectangle(x, y, x + 0.6, y + side * 0.3);
    const double gap = random.uniform(0.58, 0.7);
    synthetic::append(floor.unknown, synthetic::rectangle(4.5, y - side * gap, x + 0.6, y - side * (gap + 0.2)));
    EXPECT_LT(floor.run(40), 20) << round;
    EXPECT_GE(floor.drivers[0].closest, 0.21);
  }
}

TEST(RouteFollower, PassesAGapWhereItIsWidest) {
  // What is nearer on one side may be nearer still: lasers measure what is dark some centimetres too far off.
  for (const double side : {-1.0, 1.0}) {
    Floor floor = corridor(3);
    floor.send({1, 1.5, 0}, {13, 1.5});
    floor.unknown = synthetic::rectangle(6, 1.5 + side * 0.235, 7, 1.5 + side * 0.8);
    synthetic::append(floor.unknown, synthetic::rectangle(6, 1.5 - side * 0.295, 7, 1.5 - side * 0.9));
    EXPECT_LT(floor.run(60), 45);
    EXPECT_GE(floor.drivers[0].closest, 0.245) << side;
  }
}

TEST(RouteFollower, KeepsAsWideOfAWallWhileItTurnsAwayAsWhenItIsTurned) {
  // Its way leads straight away from the wall; the arc on which it turns there first comes nearer.
  for (const double y : {0.27, 0.28, 0.29}) {
    for (double heading = -0.65; heading < 0; heading += 0.05) {
      Floor floor = corridor(3);
      floor.send({5, y, heading}, {10, 1.2});
      EXPECT_LT(floor.run(40), 20) << y << " " << heading;
      EXPECT_GE(floor.drivers[0].closest, 0.255) << y << " " << heading;
    }
  }
}

TEST(RouteFollower, ArrivesBesideAGoalAtWhichThereIsNoRoom) {
  Floor floor = corridor(2);
  floor.send({1, 1, 0}, {6, 1});
  floor.unknown = {{{6.17, 0}, {6.17, 2}}};
  EXPECT_LT(floor.run(40), 20);
  Driver& driver = floor.drivers[0];
  EXPECT_GT(driver.T_plane_robot.x, 5.8);
  for (int tick = 0; tick < 100; ++tick) {
    floor.tick();
    ASSERT_EQ(driver.step.status, FollowStatus::arrived) << "and stays there";
  }
  EXPECT_GE(driver.closest, 0.21);
}

TEST(RouteFollower, SaysThatItIsBlockedAndByWhat) {
  Floor floor = corridor(2);
  floor.send({1, 1, 0}, {13, 1});
  floor.unknown = {{{6, 0}, {6, 2}}};
  floor.run(20);
  const Driver& driver = floor.drivers[0];
  EXPECT_EQ(driver.step.status, FollowStatus::blocked);
  ASSERT_TRUE(driver.step.obstruction.has_value());
  EXPECT_NEAR(project(floor.builder.map, *driver.step.obstruction).x(), 6, 0.4);
  EXPECT_GE(driver.closest, 0.21);
}

TEST(RouteFollower, GoesBackFromWhereItsWheelsSlip) {
  Floor floor = corridor(2);
  floor.send({1, 1, 0}, {13, 1});
  Driver& driver = floor.drivers[0];
  driver.snag = 6;
  floor.run(20);
  EXPECT_EQ(driver.step.status, FollowStatus::blocked);
  EXPECT_GT(driver.T_odom_robot.x, 7);  // as if it got on
  double least = driver.T_plane_robot.x;
  for (int tick = 0; tick < 200; ++tick) {
    floor.tick();
    least = std::min(least, driver.T_plane_robot.x);
  }
  EXPECT_LT(least, 5);
}

TEST(RouteFollower, IsNotJerkedByARefit) {
  Floor still = two_rooms();
  still.send({1, 1, 0}, {11, 4});
  Floor moved = two_rooms();
  moved.send({1, 1, 0}, {11, 4});
  for (int k = 0; k < 60; ++k) {
    still.tick();
    moved.tick();
    EXPECT_NEAR(moved.drivers[0].step.command.speed, still.drivers[0].step.command.speed, 1e-6);
    EXPECT_NEAR(moved.drivers[0].step.command.turn_rate, still.drivers[0].step.command.turn_rate, 1e-6);
    // All patches go elsewhere together with what stands on them.
    const Pose2 T_new_old{3.0 * std::sin(k), 0.7 * k, 0.3 * k};
    MapEditor editor(moved.builder.map);
    for (const PatchId id : moved.builder.patches()) {
      editor.set_pose(id, T_new_old * moved.builder.map.T_plane_patch(id));
    }
    const auto put = [&](Vector2d& p) { p = T_new_old * p; };
    for (Wall& wall : moved.walls) {
      put(wall.from);
      put(wall.to);
    }
    moved.drivers[0].T_plane_robot = T_new_old * moved.drivers[0].T_plane_robot;
  }
}

}  // namespace
}  // namespace helicoid
