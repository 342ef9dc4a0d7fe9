// What becomes of a robot whose odometry misleads it.
#include <gtest/gtest.h>

#include <algorithm>

#include "helicoid/mapping/mapper.hpp"
#include "tests/known_building.hpp"

namespace helicoid {
namespace {

using synthetic::Drive;
using synthetic::lms200;
using synthetic::look;

/// Appends the next scan, 0.2 s after the last, with a centimetre of noise.
void take_scan(Drive& drive, const RayCaster& walls, const Pose2& T_world_robot, const Pose2& T_odom_robot,
               Random& random) {
  Scan scan = look(walls, lms200(), T_world_robot);
  for (float& range : scan.ranges) range += 0.01F * static_cast<float>(random.normal());
  scan.T_odom_robot = T_odom_robot;
  drive.events.push_back({make_id<RobotId>(0), 0.2 * static_cast<double>(drive.truth.size()), scan});
  drive.truth.push_back(T_world_robot);
}

/// How far off the first scan's frame the map has the robot when each scan from `first` on was taken; the largest,
/// metres.
double worst_error(const Drive& drive, std::size_t first = 0) {
  Mapper mapper;
  mapper.add_robot("robot1", {lms200()});
  double worst = 0;
  for (std::size_t i = 0; i < drive.events.size(); ++i) {
    const Step step = mapper.process(drive.events[i]);
    if (i < first) continue;
    const Pose2 T_first_now = drive.truth[0].inverse() * drive.truth[i];
    worst = std::max(worst, (T_first_now.inverse() * mapper.map().project(step.pose)).distance());
  }
  return worst;
}

/// Into a blind corridor and slowly out of it again, backwards: few beams tell of the way along it. The odometry counts
/// wheel turns and knows no backwards, as that of some recorded logs.
Drive out_of_a_blind_corridor(std::uint64_t seed) {
  constexpr double kStep = 0.01;
  constexpr int kSteps = 60;
  const std::vector<Segment> corridor{{{0, 0}, {6, 0}}, {{6, 0}, {6, 3}}, {{6, 3}, {0, 3}}, {{0, 3}, {0, 0}}};
  const RayCaster walls(corridor);
  Random random(seed);
  Drive result;
  Pose2 T_world_robot{1, 1.5, 0};
  Pose2 T_odom_robot;
  for (int k = -kSteps; k < kSteps; ++k) {
    T_world_robot.x += k < 0 ? kStep : -kStep;
    T_odom_robot = T_odom_robot * Pose2{kStep * (1 + 0.02 * random.normal()), 0, 0.002 * random.normal()};
    take_scan(result, walls, T_world_robot, T_odom_robot, random);
  }
  return result;
}

TEST(Tracking, OdometryDoesNotOutweighWhatScanAfterScanSays) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_LT(worst_error(out_of_a_blind_corridor(seed)), 0.05) << seed;
  }
}

/// Along a corridor whose end is seen. For three scans the odometry stands still, then it makes up for them in one
/// step, as some recorded logs do: 0.8 m in 0.2 s.
Drive with_late_odometry(std::uint64_t seed) {
  constexpr double kStep = 0.2;
  std::vector<Segment> corridor{{{0, 0}, {16, 0}}, {{16, 0}, {16, 2}}, {{16, 2}, {0, 2}}, {{0, 2}, {0, 0}}};
  for (const double x : {4.0, 8.0, 12.0}) {
    corridor.push_back({{x, 2}, {x, 1.7}});
    corridor.push_back({{x + 1, 0}, {x + 1, 0.3}});
  }
  const RayCaster walls(corridor);
  Random random(seed);
  Drive result;
  Pose2 T_odom_late;
  for (int k = 0; k < 60; ++k) {
    const Pose2 T_world_robot{1 + kStep * k, 1, 0};
    if (k % 20 < 10 || k % 20 > 12) T_odom_late = T_world_robot;
    take_scan(result, walls, T_world_robot, T_odom_late, random);
  }
  return result;
}

TEST(Tracking, OdometryThatStandsStillForAWhileIsNotFollowed) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_LT(worst_error(with_late_odometry(seed)), 0.10) << seed;
  }
}

TEST(Tracking, WhomItsMatchesHeldBackIsFoundAgainByOdometry) {
  constexpr std::size_t kFrozen = 16;  // scans: 0.8 m
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Drive twice = synthetic::drive(2, seed);
    const std::size_t from = twice.events.size() / 5;
    const auto ranges = [&](std::size_t i) -> std::vector<float>& {
      return std::get<Scan>(twice.events[i].body).ranges;
    };
    // The laser says the same for a while, and holds the robot where it said that first.
    for (std::size_t i = from + 1; i <= from + kFrozen; ++i) ranges(i) = ranges(from);
    EXPECT_LT(worst_error(twice, from + kFrozen + 3), 0.05) << seed;
  }
}

}  // namespace
}  // namespace helicoid
