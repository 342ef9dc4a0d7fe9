#include "helicoid/mapping/point_alignment.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

std::vector<PointPair> pairs_of(const Pose2& T_a_b, int right, int wrong, Random& random) {
  const auto any = [&] { return Vector2d(random.uniform(-5, 5), random.uniform(-5, 5)); };
  std::vector<PointPair> pairs;
  for (int i = 0; i < right + wrong; ++i) {
    const Vector2d p_b = any();
    const Vector2d noise(0.05 * random.normal(), 0.05 * random.normal());
    pairs.push_back({i < right ? Vector2d(T_a_b * p_b + noise) : any(), p_b});
  }
  return pairs;
}

TEST(PointAlignment, FindsTheTransformThoughAThirdOfThePairsAreWrong) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Pose2 T_a_b{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)};
    const PointAlignment found = align_pairs(pairs_of(T_a_b, 40, 20, random));
    EXPECT_TRUE(found.determined);
    EXPECT_LT((found.T_a_b.inverse() * T_a_b).distance(), 0.2);
    EXPECT_LT(std::abs((found.T_a_b.inverse() * T_a_b).yaw), 0.05);
  }
}

TEST(PointAlignment, PointsInOnePlaceDetermineNoHeading) {
  std::vector<PointPair> pairs;
  pairs.reserve(50);
  for (int i = 0; i < 50; ++i) pairs.push_back({{0.01 * i, 0}, {3, 0.01 * i}});
  EXPECT_FALSE(align_pairs(pairs).determined);
}

TEST(PointAlignment, PairsThatDisagreeDetermineNothing) {
  Random random(4);
  EXPECT_FALSE(align_pairs(pairs_of({}, 0, 60, random)).determined);
  EXPECT_FALSE(align_pairs({}).determined);
}

}  // namespace
}  // namespace helicoid
