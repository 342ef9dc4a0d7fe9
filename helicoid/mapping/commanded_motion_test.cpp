#include "helicoid/mapping/commanded_motion.hpp"

#include <gtest/gtest.h>

namespace helicoid {
namespace {

/// A quarter of a circle of a metre in two seconds, then a second straight ahead, told ten times a second.
std::vector<Velocity> quarter_and_straight() {
  std::vector<Velocity> told;
  for (int k = 0; k < 30; ++k) {
    const double turning = k < 20 ? radians(45) : 0;
    told.push_back({100 + 0.1 * k, radians(45), turning});
  }
  return told;
}

void expect_near(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.y, b.y, 1e-9);
  EXPECT_NEAR(wrap_angle(a.yaw - b.yaw), 0, 1e-9);
}

TEST(CommandedMotion, FollowsArcsExactly) {
  const std::vector<Velocity> told = quarter_and_straight();
  const CommandedMotion motion(told, {});
  expect_near(motion.between(100, 102), {1, 1, radians(90)});
  expect_near(motion.between(100, 103), {1, 1 + radians(45), radians(90)});
}

TEST(CommandedMotion, WaysAddUpWhereverTheyAreCut) {
  const std::vector<Velocity> told = quarter_and_straight();
  OdometryModel model;
  model.delay = 0.13;
  model.veer = 0.2;
  model.sideways_gain = -0.1;
  const CommandedMotion motion(told, model);
  for (const double cut : {100.0, 100.05, 101.234, 102.9}) {
    expect_near(motion.between(99, 104), motion.between(99, cut) * motion.between(cut, 104));
  }
}

TEST(CommandedMotion, ADelayShiftsTheWayAndGainsScaleIt) {
  const std::vector<Velocity> told = quarter_and_straight();
  OdometryModel model;
  model.delay = 0.4;
  expect_near(CommandedMotion(told, model).between(100.4, 102.4), {1, 1, radians(90)});
  model = {};
  model.forward_gain = 0.5;
  expect_near(CommandedMotion(told, model).between(100, 102), {0.5, 0.5, radians(90)});
  model = {};
  model.turning_gain = 0;
  expect_near(CommandedMotion(told, model).between(100, 102), {2 * radians(45), 0, 0});
}

TEST(CommandedMotion, ARobotStandsBeforeItIsToldAnythingAndLongAfter) {
  const std::vector<Velocity> told = quarter_and_straight();
  const CommandedMotion motion(told, {});
  expect_near(motion.between(0, 100), {});
  expect_near(motion.between(110, 1e6), {});
  expect_near(CommandedMotion({}, {}).between(0, 10), {});
  EXPECT_NEAR(motion.told(100, 102).turning, radians(90), 1e-9);
}

}  // namespace
}  // namespace helicoid
