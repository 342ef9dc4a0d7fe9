#include "helicoid/exploration/team_assignment.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

using testing::ElementsAre;
using testing::Optional;

using Choice = std::vector<std::optional<std::size_t>>;

/// A frontier that shows this much, in a square of its own unless `square` says otherwise.
Frontier frontier(double gain_m2, std::int32_t square) {
  Frontier f;
  f.island = IslandId{0};
  f.gain_m2 = gain_m2;
  f.seen = {{square, 0, gain_m2}};
  return f;
}

TEST(TeamAssignment, TwoRobotsNeverGetTheSameFrontierWhereThereAreTwoEquallyGood) {
  const std::vector<Frontier> frontiers = {frontier(5, 0), frontier(5, 1)};
  const Eigen::MatrixXd way = Eigen::MatrixXd::Constant(2, 2, 7);
  const Choice chosen = assign_frontiers(frontiers, way, Choice(2));
  ASSERT_TRUE(chosen[0] && chosen[1]);
  EXPECT_NE(*chosen[0], *chosen[1]);
}

TEST(TeamAssignment, IsTheTeamsBestAndNotFirstComeFirstServed) {
  const std::vector<Frontier> frontiers = {frontier(5, 0), frontier(5, 1)};
  Eigen::MatrixXd way(2, 2);
  way << 1, 2,  // the first robot's nearest is the only one that the second can get to cheaply
      2, 20;
  EXPECT_THAT(assign_frontiers(frontiers, way, Choice(2)), ElementsAre(Optional(1U), Optional(0U)));
  EXPECT_THAT(nearest_frontiers(way), ElementsAre(Optional(0U), Optional(0U)));
}

TEST(TeamAssignment, WhatATeammateWillSeeCountsOnce) {
  // The second and the third show the same floor; the third robot's way to other floor is longer.
  const std::vector<Frontier> frontiers = {frontier(8, 0), frontier(8, 0), frontier(8, 1)};
  Eigen::MatrixXd way(2, 3);
  way << 2, 3, 9,  //
      2, 2.5, 4;
  EXPECT_THAT(assign_frontiers(frontiers, way, Choice(2)), ElementsAre(Optional(0U), Optional(2U)));
}

TEST(TeamAssignment, IsNeverWorseThanTheBestIgnoringWhatIsShared) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<Frontier> frontiers(6);
    for (Frontier& f : frontiers) {
      const double gain = random.uniform(0.5, 15);
      f = frontier(gain, static_cast<std::int32_t>(random.below(4)));
    }
    Eigen::MatrixXd way(3, 6);
    for (double& w : way.reshaped()) w = random.uniform(0, 30);
    const AssignmentOptions options;
    const Choice chosen = assign_frontiers(frontiers, way, Choice(3), options);
    const double rate = team_rate(frontiers, way, Choice(3), chosen, options);
    // No robot alone, and no two by changing places, can make it better.
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t f = 0; f < 6; ++f) {
        Choice other = chosen;
        const auto holder = std::find(other.begin(), other.end(), std::optional(f));
        if (holder != other.end()) *holder = other[r];
        other[r] = f;
        EXPECT_LE(team_rate(frontiers, way, Choice(3), other, options), rate + 1e-9);
      }
    }
  }
}

TEST(TeamAssignment, ARobotGoesOnToItsFrontierUnlessAnotherIsClearlyBetter) {
  const std::vector<Frontier> frontiers = {frontier(5, 0), frontier(5, 1)};
  Eigen::MatrixXd way(1, 2);
  way << 6, 5;
  EXPECT_THAT(assign_frontiers(frontiers, way, Choice{0U}), ElementsAre(Optional(0U)));
  way << 6, 4;
  EXPECT_THAT(assign_frontiers(frontiers, way, Choice{0U}), ElementsAre(Optional(1U)));
}

TEST(TeamAssignment, WhoHasOnlyScrapsNearByHelpsWhereARoomIsLeft) {
  const std::vector<Frontier> frontiers = {frontier(0.3, 0), frontier(20, 1), frontier(20, 2)};
  Eigen::MatrixXd way(2, 3);
  way << 4, 20, 20,  //
      24, 2, 2;
  const Choice chosen = assign_frontiers(frontiers, way, Choice(2));
  ASSERT_TRUE(chosen[0] && chosen[1]);
  EXPECT_NE(*chosen[0], 0U);
  EXPECT_NE(*chosen[1], 0U);
}

TEST(TeamAssignment, AScrapOnTheWayIsNotLeftForLater) {
  const std::vector<Frontier> frontiers = {frontier(0.3, 0), frontier(20, 1)};
  Eigen::MatrixXd way(1, 2);
  way << 0.5, 12;
  EXPECT_THAT(assign_frontiers(frontiers, way, Choice(1)), ElementsAre(Optional(0U)));
}

TEST(TeamAssignment, WhatShowsMoreByTheMetreIsLookedAtFirst) {
  const std::vector<Frontier> frontiers = {frontier(6, 0), frontier(9, 1)};
  Eigen::MatrixXd way(1, 2);
  way << 1, 4;  // the farther one shows more, but by the metre less
  EXPECT_THAT(assign_frontiers(frontiers, way, Choice(1)), ElementsAre(Optional(0U)));
}

TEST(TeamAssignment, WhereThereIsNoWayNobodyIsSent) {
  const std::vector<Frontier> frontiers = {frontier(5, 0)};
  Eigen::MatrixXd way(2, 1);
  way << std::numeric_limits<double>::infinity(), 30;
  const Choice chosen = assign_frontiers(frontiers, way, Choice(2));
  EXPECT_FALSE(chosen[0].has_value());
  EXPECT_THAT(chosen[1], Optional(0U));
}

}  // namespace
}  // namespace helicoid
