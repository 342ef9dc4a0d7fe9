#include "helicoid/mapping/loop_closer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "helicoid/manifold/confidence.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

constexpr std::uint32_t kLength = 60;  // patches, a metre apart

/// Twice along a hall, each time well known in itself; how the two lie is for the ledger to say.
struct TwoWays {
  synthetic::Builder builder;
  LoopCloser closer{MapperOptions{}};

  TwoWays() {
    const std::vector<synthetic::Wall> walls = synthetic::rectangle(0, 0, kLength + 2, 3);
    for (std::uint32_t i = 0; i < 2 * kLength; ++i) {
      const Pose2 taken{1.0 + i % kLength, 1.5, 0};
      builder.add(walls, taken, taken);
      if (i % kLength > 0) {
        builder.relate(PatchId{i - 1}, PatchId{i}, RelationKind::chain, Vector3d(1e6, 1e6, 1e6));
      }
    }
  }
  /// The second way's patch k was perhaps taken where the first way's patch i lies, give or take so much along the
  /// hall, and so much farther along.
  std::vector<std::size_t> consider(std::uint32_t i, std::uint32_t k, double sigma_along, double farther = 0) {
    Hypothesis h;
    h.a = PatchId{i};
    h.b = PatchId{kLength + k};
    h.T_a_b.T_a_b = {farther, 0, 0};
    h.T_a_b.covariance.diagonal() << sigma_along * sigma_along, 1e-3, 1e-4;
    h.score = 0.9;
    return closer.consider_within(builder.map, information_graph(builder.map), h);
  }
};

TEST(LoopCloser, WhatAgreesOnlyAlongAnOpenDirectionIsNotAcceptedAlong) {
  TwoWays ways;
  // Too far from what comes then for anything to speak against it.
  EXPECT_TRUE(ways.consider(42, 47, 0.03).empty());
  for (const std::uint32_t i : {0U, 4U, 8U}) ways.consider(i, i, 0.03);
  ASSERT_EQ(count_closures(ways.closer.ledger()), 3U);
  const std::vector<std::size_t> accepted = ways.consider(20, 20, 10);
  ASSERT_EQ(ways.closer.ledger().back().supports.size(), 4U);
  EXPECT_EQ(accepted, std::vector<std::size_t>{4});
  EXPECT_TRUE(ways.closer.ledger().front().is_undecided());
}

/// Once along a hall and back again without a break, so well known that places a few metres aside are ruled out.
struct ThereAndBack {
  TwoWays ways;

  explicit ThereAndBack(double sigma_turning) {
    const double information = 1 / (sigma_turning * sigma_turning);
    ways.builder.relate(PatchId{kLength - 1}, PatchId{kLength}, RelationKind::chain,
                        Vector3d(information, information, 1e6));
  }
  /// Places that agree with one another, and of which each lies so much farther along than where the map has it.
  std::size_t accepted(double aside) {
    for (const std::uint32_t i : {10U, 14U, 18U, 22U}) ways.consider(i, i, 0.03, aside);
    return count_closures(ways.closer.ledger());
  }
};

TEST(LoopCloser, HoweverManyAgreeTheyAreLeftOpenWhereTheMapRulesThemOut) {
  ThereAndBack known(0.2);
  EXPECT_EQ(known.accepted(8), 0U);
  const Ledger& ledger = known.ways.closer.ledger();
  EXPECT_TRUE(std::any_of(ledger.begin(), ledger.end(), is_left_open));
  EXPECT_GT(ThereAndBack(0.2).accepted(0.5), 0U) << "that is no other place";
  EXPECT_GT(ThereAndBack(3).accepted(8), 0U) << "the map does not know it that well";
}

}  // namespace
}  // namespace helicoid
