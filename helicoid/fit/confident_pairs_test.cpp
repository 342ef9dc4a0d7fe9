#include "helicoid/fit/confident_pairs.hpp"

#include <gtest/gtest.h>

#include "helicoid/fit/half_solves.hpp"
#include "tests/random_graph.hpp"

namespace helicoid {
namespace {

/// A robot's way with some loops closed: a connected graph of relations of all strengths.
FormGraph random_way(Random& random, std::uint32_t count) {
  FormGraph way;
  const auto relate = [&](std::uint32_t a, std::uint32_t b) {
    const double sigma = random.uniform(0.01, 0.06);
    way.relate(a, b, Vector3d(1, random.uniform(0.2, 2), 8).asDiagonal() * (1 / (sigma * sigma)));
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    way.poses.push_back(i == 0 ? Pose2{} : way.poses.back() * Pose2{0.7, 0.1 * random.normal(), 0.4 * random.normal()});
    if (i > 0) relate(i - 1, i);
  }
  for (std::uint32_t k = 0; k < count / 3; ++k) {
    const auto a = static_cast<std::uint32_t>(random.below(count - 1));
    relate(a, a + 1 + static_cast<std::uint32_t>(random.below(count - 1 - a)));
  }
  return way;
}

std::vector<PosePair> all_pairs(std::size_t count) {
  std::vector<PosePair> pairs;
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) pairs.push_back({a, b});
  }
  return pairs;
}

TEST(HalfSolves, AnswerAsASolveForEachPairDoes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const FormGraph way = random_way(random, 3 + static_cast<std::uint32_t>(random.below(60)));
    const RelativeCovariance covariance(way.poses, way.edges);
    ASSERT_TRUE(covariance.is_determined());
    HalfSolves kept(covariance.system());
    HalfSolves forgetful(covariance.system(), 0);
    for (const auto& [a, b] : all_pairs(way.poses.size())) {
      const UncertainPose2 expected = covariance.of(a, b);
      EXPECT_TRUE(kept.relative_covariance(expected.T_a_b, a, b).isApprox(expected.covariance, 1e-9));
      EXPECT_TRUE(forgetful.relative_covariance(expected.T_a_b, a, b).isApprox(expected.covariance, 1e-9));
    }
  }
}

TEST(ConfidentPairs, AreThoseWhoseExactIntervalKeepsToTheLimits) {
  std::size_t confident = 0;
  std::size_t doubtful = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const FormGraph way = random_way(random, 2 + static_cast<std::uint32_t>(random.below(80)));
    const RelativeCovariance covariance(way.poses, way.edges);
    const std::vector<PosePair> pairs = all_pairs(way.poses.size());
    std::vector<PosePair> expected;
    for (const PosePair& pair : pairs) {
      const ConfidenceInterval interval = midway_interval(covariance.of(pair.a, pair.b));
      if (interval.position < 0.15 && interval.heading < 0.06) expected.push_back(pair);
    }
    EXPECT_EQ(confident_pairs(way.poses, covariance, pairs, {0.15, 0.06}), expected) << seed;
    confident += expected.size();
    doubtful += pairs.size() - expected.size();
  }
  EXPECT_GT(confident, 1000U);
  EXPECT_GT(doubtful, 1000U);
}

TEST(ConfidentPairs, AreNoneWhereAPoseHangsInTheAir) {
  const std::vector<Pose2> poses{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const PairForm form = pose_pose_form({1, 0, 0}, 1e6 * Matrix3d::Identity());
  const std::vector<GraphEdge> edges{{0, 1, &form, 1}};
  EXPECT_TRUE(confident_pairs(poses, RelativeCovariance(poses, edges), all_pairs(3)).empty());
}

TEST(MidwayInterval, IsTheSameFromEitherEndAndNeverLargerThanTheirMean) {
  Random random(5);
  for (int round = 0; round < 200; ++round) {
    Matrix3d A;
    for (double& x : A.reshaped()) x = 0.1 * random.normal();
    const UncertainPose2 ab{{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)}, A * A.transpose()};
    const ConfidenceInterval there = midway_interval(ab);
    const ConfidenceInterval back = midway_interval(invert(ab));
    EXPECT_NEAR(there.position, back.position, 1e-9);
    EXPECT_NEAR(there.heading, back.heading, 1e-9);
    const double ends =
        confidence_interval(ab.covariance).position + confidence_interval(invert(ab).covariance).position;
    EXPECT_LE(there.position, 0.5 * ends + 1e-9);
  }
}

}  // namespace
}  // namespace helicoid
