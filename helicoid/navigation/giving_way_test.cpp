// How robots that know nothing of one another but what they see get past one another.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/synthetic_floor.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;
using synthetic::corridor;
using synthetic::Driver;
using synthetic::Floor;
using synthetic::mapped_from;
using synthetic::two_rooms;
using synthetic::Wall;

TEST(RobotsThatMeet, PassEachOtherInACorridor) {
  for (const double width : {1.3, 1.6, 2.0, 3.0}) {
    Floor floor = corridor(width);
    floor.send({1, width / 2, 0}, {13, width / 2}, 0);
    floor.send({13, width / 2, 3.1}, {1, width / 2}, 1);
    EXPECT_LT(floor.run(90), 70) << width;
    for (const Driver& driver : floor.drivers) EXPECT_GE(driver.closest, 0.205) << width;
  }
}

TEST(RobotsThatMeet, DoNotTouchWhereTheirWaysComeTogether) {
  const std::vector<Wall> walls = synthetic::rectangle(0, 0, 8, 6);
  Random random(4);
  for (int round = 0; round < 40; ++round) {
    const Pose2 poses[] = {Pose2{1, 1, 0.7}, {7, 5, -2.4}, {4, 3, 0}};
    Floor floor = mapped_from(poses, walls);
    // Side by side, each bound for where the other's side leads to.
    const double apart = random.uniform(0.6, 2.0);
    const double y = random.uniform(2.2, 3.8);
    floor.send({1, y - apart / 2, random.uniform(0, 0.8)}, {random.uniform(2, 7), y + random.uniform(0, 1.5)}, 0);
    floor.send({1, y + apart / 2, -random.uniform(0, 0.8)}, {random.uniform(2, 7), y - random.uniform(0, 1.5)}, 1);
    floor.run(60);
    for (const Driver& driver : floor.drivers) EXPECT_GE(driver.closest, 0.22) << round;
  }
}

TEST(RobotsThatMeet, DoNotTouchWhereTheirWaysCross) {
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

TEST(RobotsThatMeet, GiveWayAtADoorByRank) {
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

TEST(RobotsThatMeet, GetOutOfAPassageThatHasRoomForOne) {
  std::vector<Wall> walls = synthetic::rectangle(0, 0, 4, 4);
  walls = {{{0, 0}, {4, 0}},     {{4, 0}, {4, 1.5}}, {{4, 1.5}, {9, 1.5}}, {{9, 1.5}, {9, 0}},
           {{9, 0}, {13, 0}},    {{13, 0}, {13, 4}}, {{13, 4}, {9, 4}},    {{9, 4}, {9, 2.4}},
           {{9, 2.4}, {4, 2.4}}, {{4, 2.4}, {4, 4}}, {{4, 4}, {0, 4}},     {{0, 4}, {0, 0}}};
  const Pose2 poses[] = {Pose2{1, 1, 0.3}, {1, 3, -0.3}, {3, 2, 0},    {3, 2, 3.1}, {6.5, 1.95, 0},
                         {6.5, 1.95, 3.1}, {10, 2, 0},   {10, 2, 3.1}, {12, 3, 3.1}};
  Floor floor = mapped_from(poses, walls);
  floor.send({1, 2, 0}, {12, 2}, 0);
  floor.send({12, 2, 3.1}, {1, 2}, 1);
  EXPECT_LT(floor.run(200), 150);
  for (const Driver& driver : floor.drivers) {
    EXPECT_EQ(driver.step.status, FollowStatus::arrived);
    EXPECT_GE(driver.closest, 0.205);
  }
}

TEST(RobotsThatMeet, ComeBackRoundACornerToWhereTheyGaveWay) {
  const std::vector<Wall> walls = {
      {{0, 0}, {4, 0}},   {{4, 0}, {4, 1.5}},   {{4, 1.5}, {7.9, 1.5}}, {{7.9, 1.5}, {7.9, 9}}, {{7.9, 9}, {7, 9}},
      {{7, 9}, {7, 2.4}}, {{7, 2.4}, {4, 2.4}}, {{4, 2.4}, {4, 4}},     {{4, 4}, {0, 4}},       {{0, 4}, {0, 0}}};
  const Pose2 poses[] = {Pose2{1, 1, 0.3}, {1, 3, -0.3},    {3, 2, 0},       {3, 2, 3.1},     {6, 1.95, 0},
                         {6, 1.95, 3.1},   {7.45, 2, 1.57}, {7.45, 5, 1.57}, {7.45, 5, -1.57}};
  Floor floor = mapped_from(poses, walls);
  floor.send({2, 2, 0}, {7.45, 8.5});
  floor.unknown = {{{7, 6.5}, {7.9, 6.5}}};
  Driver& driver = floor.drivers[0];
  for (int tick = 0; tick < 250; ++tick) floor.tick();
  EXPECT_GT(driver.T_plane_robot.y, 3) << "has come to what bars its way";
  for (int tick = 0; tick < 600 && driver.T_plane_robot.x > 3.8; ++tick) floor.tick();
  ASSERT_LT(driver.T_plane_robot.x, 3.8) << "has gone back to where there is room";
  floor.unknown = {};
  EXPECT_LT(floor.run(60), 45);
  EXPECT_GE(driver.closest, 0.205);
}

}  // namespace
}  // namespace helicoid
