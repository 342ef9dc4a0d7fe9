#include "helicoid/navigation/route_follower.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/synthetic_floor.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;
using synthetic::Driver;
using synthetic::Floor;
using synthetic::outline;
using synthetic::Wall;

/// Two rooms with a door of 0.9 m between them, one with a table.
Floor two_rooms() {
  std::vector<Wall> walls = synthetic::rectangle(0, 0, 12, 5);
  synthetic::append(walls, {{{6, 0}, {6, 2.55}}, {{6, 3.45}, {6, 5}}});
  synthetic::append(walls, synthetic::rectangle(8, 1.5, 9.5, 2.5));
  Floor floor{walls, Builder(), {}};
  for (const Pose2& pose : {Pose2{1, 1, 0.5},
                            {1, 4, -0.5},
                            {4.5, 3, 0},
                            {4.5, 3, 3.1},
                            {7.5, 3, 0},
                            {7.5, 3, 3.1},
                            {11, 1, 2.0},
                            {11, 4, -2.5}}) {
    floor.builder.add(walls, pose);
  }
  return floor;
}

/// A corridor that is known from either end.
Floor corridor(double width) {
  const std::vector<Wall> walls = synthetic::rectangle(0, 0, 14, width);
  Floor floor{walls, Builder(), {}};
  for (double x = 1; x < 14; x += 2) {
    floor.builder.add(walls, {x, width / 2, 0});
    floor.builder.add(walls, {x, width / 2, 3.1});
  }
  return floor;
}

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

TEST(RouteFollower, PassesAnotherInACorridor) {
  for (const double width : {1.3, 1.6, 2.0, 3.0}) {
    Floor floor = corridor(width);
    floor.send({1, width / 2, 0}, {13, width / 2}, 0);
    floor.send({13, width / 2, 3.1}, {1, width / 2}, 1);
    EXPECT_LT(floor.run(90), 70) << width;
    for (const Driver& driver : floor.drivers) EXPECT_GE(driver.closest, 0.205) << width;
  }
}

TEST(RouteFollower, DoesNotTouchAnotherWhoseWayComesTogetherWithItsOwn) {
  const std::vector<Wall> walls = synthetic::rectangle(0, 0, 8, 6);
  Random random(4);
  for (int round = 0; round < 40; ++round) {
    Floor floor{walls, Builder(), {}};
    for (const Pose2& pose : {Pose2{1, 1, 0.7}, {7, 5, -2.4}, {4, 3, 0}}) floor.builder.add(walls, pose);
    // Side by side, each bound for where the other's side leads to.
    const double apart = random.uniform(0.6, 2.0);
    const double y = random.uniform(2.2, 3.8);
    floor.send({1, y - apart / 2, random.uniform(0, 0.8)}, {random.uniform(2, 7), y + random.uniform(0, 1.5)}, 0);
    floor.send({1, y + apart / 2, -random.uniform(0, 0.8)}, {random.uniform(2, 7), y - random.uniform(0, 1.5)}, 1);
    floor.run(60);
    for (const Driver& driver : floor.drivers) EXPECT_GE(driver.closest, 0.22) << round;
  }
}

TEST(RouteFollower, DoesNotTouchAnotherWhoseWayCrossesItsOwn) {
  const std::vector<Wall> walls = synthetic::rectangle(-5, -5, 5, 5);
  Random random(5);
  for (int round = 0; round < 40; ++round) {
    Floor floor{walls, Builder(), {}};
    for (const double yaw : {0.0, 1.57, 3.14, -1.57}) floor.builder.add(walls, {0, 0, yaw});
    // Both are at the crossing at about the same time: each sees the other at the same bearing all along.
    const double crossing = random.uniform(0.7, 2.4);
    for (const int rank : {0, 1}) {
      const double heading = rank * crossing;
      const Vector2d along(std::cos(heading), std::sin(heading));
      const Vector2d from = -random.uniform(2.5, 2.9) * along;
      floor.send({from.x(), from.y(), heading}, 3 * along, rank);
    }
    EXPECT_LT(floor.run(60), 25) << round;
    for (const Driver& driver : floor.drivers) EXPECT_GE(driver.closest, 0.22) << round;
  }
}

TEST(RouteFollower, GivesWayAtADoorByRank) {
  for (const int first : {0, 1}) {
    Floor floor = two_rooms();
    floor.send({1, 3, 0}, {11, 3}, first);
    floor.send({11, 3, 3.1}, {1, 3}, 1 - first);
    EXPECT_LT(floor.run(150), 120);
    for (const Driver& driver : floor.drivers) {
      EXPECT_EQ(driver.step.status, FollowStatus::arrived);
      EXPECT_GE(driver.closest, 0.205);
    }
  }
}

TEST(RouteFollower, GetsOutOfAPassageThatHasRoomForOne) {
  std::vector<Wall> walls = synthetic::rectangle(0, 0, 4, 4);
  walls = {{{0, 0}, {4, 0}},     {{4, 0}, {4, 1.5}}, {{4, 1.5}, {9, 1.5}}, {{9, 1.5}, {9, 0}},
           {{9, 0}, {13, 0}},    {{13, 0}, {13, 4}}, {{13, 4}, {9, 4}},    {{9, 4}, {9, 2.4}},
           {{9, 2.4}, {4, 2.4}}, {{4, 2.4}, {4, 4}}, {{4, 4}, {0, 4}},     {{0, 4}, {0, 0}}};
  Floor floor{walls, Builder(), {}};
  for (const Pose2& pose : {Pose2{1, 1, 0.3},
                            {1, 3, -0.3},
                            {3, 2, 0},
                            {3, 2, 3.1},
                            {6.5, 1.95, 0},
                            {6.5, 1.95, 3.1},
                            {10, 2, 0},
                            {10, 2, 3.1},
                            {12, 3, 3.1}}) {
    floor.builder.add(walls, pose);
  }
  floor.send({1, 2, 0}, {12, 2}, 0);
  floor.send({12, 2, 3.1}, {1, 2}, 1);
  EXPECT_LT(floor.run(200), 150);
  for (const Driver& driver : floor.drivers) {
    EXPECT_EQ(driver.step.status, FollowStatus::arrived);
    EXPECT_GE(driver.closest, 0.205);
  }
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
