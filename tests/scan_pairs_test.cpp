#include "apps/experiments/scan_pairs.hpp"

#include <gtest/gtest.h>

#include "helicoid/mapping/relate.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

const Pose2 kA{2, 3, 0.1};
const Pose2 kB{2.5, 3.1, 0.4};

Patch view(const std::vector<synthetic::Wall>& walls, const Pose2& T_plane_robot) {
  const LaserModel laser = synthetic::test_laser();
  return make_patch(PatchId{0}, RobotId{0}, 0, 0, synthetic::take_scan(walls, T_plane_robot, laser), laser);
}

TEST(MatchScans, FindsThePoseFromANearOneWhicheverHalfOfTheBeamsItReads) {
  const std::vector<synthetic::Wall> room = synthetic::pillar_room();
  const Pose2 T_a_b = kA.inverse() * kB;
  const auto match = match_scans(view(room, kA), view(room, kB), T_a_b * Pose2{0.04, -0.03, 0.02});
  ASSERT_TRUE(match);
  const Pose2 off = T_a_b.inverse() * match->T_a_b;
  EXPECT_LT(off.distance(), 1e-3);
  EXPECT_LT(std::abs(off.yaw), 1e-3);
  EXPECT_LT(match->halves_apart.distance(), 2e-3);
  EXPECT_LT(std::abs(match->halves_apart.yaw), 1e-3);
}

TEST(MatchScans, HasNoAnswerWhereSurfacesLeaveADirectionOpen) {
  const std::vector<synthetic::Wall> corridor = synthetic::rectangle(-100, 0, 100, 2);
  EXPECT_FALSE(match_scans(view(corridor, {0, 1, 0}), view(corridor, {0.5, 1, 0}), {0.5, 0, 0}));
}

TEST(MatchScans, HasNoAnswerWhereScansSeeNothingInCommon) {
  const std::vector<synthetic::Wall> room = synthetic::pillar_room();
  EXPECT_FALSE(match_scans(view(room, kA), view(room, kB), {30, 30, 0}));
}

TEST(AgreementOfScans, IsContradictedAtAPoseThatPutsWallsIntoFreeSpace) {
  const std::vector<synthetic::Wall> room = synthetic::pillar_room();
  const Patch a = view(room, kA);
  const Patch b = view(room, kB);
  const Pose2 T_a_b = kA.inverse() * kB;
  const Agreement right = agreement(a, b, T_a_b);
  const Agreement wrong = agreement(a, b, T_a_b * Pose2{-0.5, 0.4, 0});
  EXPECT_FALSE(right.is_contradicted());
  EXPECT_TRUE(wrong.is_contradicted());
  EXPECT_TRUE(wrong.is_clearly_worse_than(right));
  EXPECT_FALSE(right.is_clearly_worse_than(wrong));
}

TEST(PoseSpread, IsARootMeanSquareAnAxis) {
  PoseSpread spread;
  spread.add({0.03, 0.04, radians(1)});
  spread.add({0, 0, radians(-1)});
  EXPECT_NEAR(spread.position_m(), 0.025, 1e-12);
  EXPECT_NEAR(spread.heading_deg(), 1, 1e-12);
  EXPECT_EQ(PoseSpread().position_m(), 0);
}

}  // namespace
}  // namespace helicoid
