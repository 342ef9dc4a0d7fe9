#include "helicoid/eval/relation_cycles.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

constexpr double kPosition = 0.01;
constexpr double kHeading = 0.004;
const Matrix3d kNoise = Vector3d(kPosition * kPosition, kPosition* kPosition, kHeading* kHeading).asDiagonal();

Pose2 jitter(Random& random, double times) {
  return {times * kPosition * random.normal(), times * kPosition * random.normal(), times * kHeading * random.normal()};
}

/// Scans in groups of three, all related within the group. Noise in units of kNoise: of each relation by itself, and
/// of each scan, which all its relations share.
std::vector<EvaluatedRelation> triangles(Random& random, int count, double of_relations, double of_scans) {
  std::vector<EvaluatedRelation> relations;
  for (int i = 0; i < count; ++i) {
    Pose2 poses[3];
    for (Pose2& pose : poses) {
      pose = Pose2{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3.1, 3.1)} * jitter(random, of_scans);
    }
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const Pose2 exact = poses[k].inverse() * poses[next];
      const Pose2 off = jitter(random, of_relations);
      const Pose2 known = Pose2::from_vector(exact.vector() + off.vector());
      relations.push_back({"", 10.0 * i + k, "", 10.0 * i + next, known});
    }
  }
  return relations;
}

TEST(RelationCycles, CloseAsOftenAsTheirNoiseSays) {
  Random random(1);
  const CycleClosure closure = close_cycles(triangles(random, 4000, 1, 0), kNoise);
  EXPECT_EQ(closure.coverage.count(), 4000U);
  EXPECT_NEAR(closure.noise_factor, 1, 0.04);
  EXPECT_NEAR(closure.coverage.region_percent(), 95, 1.4);
}

TEST(RelationCycles, TellByHowMuchTheNoiseIsLargerThanStated) {
  Random random(2);
  EXPECT_NEAR(close_cycles(triangles(random, 4000, 2.5, 0), kNoise).noise_factor, 2.5, 0.1);
}

TEST(RelationCycles, AreBlindToWhatAllRelationsOfAScanShare) {
  Random random(3);
  EXPECT_NEAR(close_cycles(triangles(random, 4000, 1, 5), kNoise).noise_factor, 1, 0.04);
}

TEST(RelationCycles, AreFoundOnceWhicheverWayTheirRelationsAreGiven) {
  Random random(4);
  std::vector<EvaluatedRelation> relations = triangles(random, 50, 1, 0);
  for (std::size_t i = 0; i < relations.size(); i += 2) {
    std::swap(relations[i].stamp_a, relations[i].stamp_b);
    relations[i].T_a_b = relations[i].T_a_b.inverse();
  }
  EXPECT_EQ(close_cycles(relations, kNoise).coverage.count(), 50U);
}

TEST(RelationCycles, OfAChainThereAreNone) {
  const std::vector<EvaluatedRelation> chain{{"", 0, "", 1, {1, 0, 0}}, {"", 1, "", 2, {1, 0, 0}}};
  EXPECT_EQ(close_cycles(chain, kNoise).coverage.count(), 0U);
  EXPECT_EQ(close_cycles(chain, kNoise).noise_factor, 0);
}

TEST(RelationCycles, DoNotMixRobotsWhoseStampsAreEqual) {
  const std::vector<EvaluatedRelation> relations{
      {"a", 0, "a", 1, {1, 0, 0}}, {"b", 1, "a", 2, {1, 0, 0}}, {"a", 2, "a", 0, {1, 0, 0}}};
  EXPECT_EQ(close_cycles(relations, kNoise).coverage.count(), 0U);
}

}  // namespace
}  // namespace helicoid
