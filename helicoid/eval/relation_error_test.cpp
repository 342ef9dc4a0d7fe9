#include "helicoid/eval/relation_error.hpp"

#include <gtest/gtest.h>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

EvaluatedTrajectory trajectory(const std::string& robot, int frame, std::vector<double> stamps,
                               std::vector<Pose2> poses) {
  return {robot, frame, std::move(stamps), std::move(poses)};
}

TEST(RelationError, OfAHandComputedCase) {
  // The second pose should be 1 m ahead; it is 1.3 m ahead, 0.4 m aside, and turned by 10 degrees.
  const std::vector<EvaluatedTrajectory> t{trajectory("", 0, {1, 2}, {{5, 5, radians(90)}, {4.6, 6.3, radians(100)}})};
  const std::vector<EvaluatedRelation> r{{"", 1, "", 2, {1, 0, 0}}};
  const RelationError error = relation_error(t, r);
  EXPECT_EQ(error.relations, 1U);
  EXPECT_EQ(error.scored, 1U);
  EXPECT_EQ(error.missing, 0U);
  EXPECT_NEAR(error.translation_m.mean, 0.5, 1e-12);
  EXPECT_NEAR(error.rotation_deg.mean, 10, 1e-9);
}

TEST(RelationError, IsWhatKuemmerlesEquationsSay) {
  // delta_ij (-) delta*_ij, its translation's length and its turn, whatever the trajectory's frame.
  Random random(1);
  std::vector<double> stamps;
  std::vector<Pose2> poses;
  for (int i = 0; i < 50; ++i) {
    stamps.push_back(i);
    poses.push_back({random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)});
  }
  std::vector<EvaluatedRelation> relations;
  double translation = 0;
  double rotation = 0;
  for (int k = 0; k < 40; ++k) {
    const auto i = static_cast<std::size_t>(random.below(50));
    const auto j = static_cast<std::size_t>(random.below(50));
    const Pose2 delta_true{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)};
    relations.push_back({"", stamps[i], "", stamps[j], delta_true});
    const Pose2 delta = ominus(poses[j], poses[i]);
    const Pose2 off = ominus(delta, delta_true);
    translation += std::hypot(off.x, off.y) / 40;
    rotation += std::abs(degrees(off.yaw)) / 40;
  }
  for (const Pose2& T : {Pose2{}, Pose2{100, -50, 2}}) {
    std::vector<Pose2> moved;
    for (const Pose2& pose : poses) moved.push_back(T * pose);
    const RelationError error = relation_error(std::vector{trajectory("", 0, stamps, moved)}, relations);
    EXPECT_NEAR(error.translation_m.mean, translation, 1e-9);
    EXPECT_NEAR(error.rotation_deg.mean, rotation, 1e-9);
  }
}

TEST(RelationError, IsZeroForTheTruth) {
  const std::vector<EvaluatedTrajectory> t{trajectory("", 0, {1, 2}, {{3, 4, 3.1}, {-3, 1, -3.1}})};
  const std::vector<EvaluatedRelation> r{{"", 1, "", 2, Pose2{3, 4, 3.1}.inverse() * Pose2{-3, 1, -3.1}}};
  EXPECT_NEAR(relation_error(t, r).translation_m.max, 0, 1e-12);
  EXPECT_NEAR(relation_error(t, r).rotation_deg.max, 0, 1e-9);
}

TEST(RelationError, TakesTheNearestPoseWithinFiveMicroseconds) {
  const std::vector<EvaluatedTrajectory> t{
      trajectory("", 0, {100, 100.000004, 200}, {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}})};
  const auto scored = [&](double a, double b) {
    return relation_error(t, std::vector<EvaluatedRelation>{{"", a, "", b, {}}});
  };
  EXPECT_EQ(scored(100.000001, 200).translation_m.mean, 5);
  EXPECT_EQ(scored(100.000003, 200).translation_m.mean, 4);
  EXPECT_EQ(scored(100.0000085, 200.0000045).translation_m.mean, 4);
  EXPECT_EQ(scored(100.00001, 200).missing, 1U);
  EXPECT_EQ(scored(99.999994, 200).missing, 1U);
  EXPECT_EQ(scored(100, 199.99999).scored, 0U);
}

TEST(RelationError, PosesNeedNotBeInOrderOfTime) {
  const std::vector<EvaluatedTrajectory> t{trajectory("", 0, {2, 1, 3}, {{2, 0, 0}, {1, 0, 0}, {3, 0, 0}})};
  EXPECT_EQ(relation_error(t, std::vector<EvaluatedRelation>{{"", 1, "", 3, {2, 0, 0}}}).translation_m.max, 0);
}

TEST(RelationError, CountsWhatIsMissingAndNeverScoresIt) {
  const std::vector<EvaluatedTrajectory> t{trajectory("r1", 0, {1, 2}, {{}, {1, 0, 0}})};
  const std::vector<EvaluatedRelation> r{
      {"r1", 1, "r1", 2, {1, 0, 0}}, {"r1", 1, "r1", 7, {}}, {"r2", 1, "r1", 2, {}}, {"r1", 1, "r9", 2, {}}};
  const RelationError error = relation_error(t, r);
  EXPECT_EQ(error.relations, 4U);
  EXPECT_EQ(error.scored, 1U);
  EXPECT_EQ(error.missing, 3U);
  EXPECT_EQ(error.translations_m.size(), 1U);
  EXPECT_EQ(error.translation_m.mean, 0);
}

TEST(RelationError, BetweenRobotsNeedsACommonFrame) {
  const std::vector<EvaluatedRelation> r{{"r1", 1, "r2", 1, {1, 0, 0}}, {"r1", 1, "r1", 1, {}}};
  std::vector<EvaluatedTrajectory> t{trajectory("r1", 0, {1}, {{}}), trajectory("r2", 0, {1}, {{1, 0, 0}})};
  EXPECT_EQ(relation_error(t, r).scored, 2U);
  t[1].frame = 1;
  EXPECT_EQ(relation_error(t, r).missing, 1U);
  RelationErrorOptions options;
  options.between_robots = true;
  EXPECT_EQ(relation_error(t, r, options).relations, 1U);
}

TEST(RelationError, TheGapLeavesLongRelationsOut) {
  const std::vector<EvaluatedTrajectory> t{trajectory("", 0, {1, 4, 90}, {{}, {}, {}})};
  RelationErrorOptions options;
  options.max_gap = 5;
  const std::vector<EvaluatedRelation> r{{"", 1, "", 4, {}}, {"", 4, "", 1, {}}, {"", 1, "", 90, {}}};
  EXPECT_EQ(relation_error(t, r, options).relations, 2U);
}

TEST(Statistics, AreThoseOfTheErrors) {
  const std::vector<double> errors{1, 2, 3, 6};
  const ErrorStatistics s = statistics(errors);
  EXPECT_DOUBLE_EQ(s.mean, 3);
  EXPECT_DOUBLE_EQ(s.rms, std::sqrt(12.5));
  EXPECT_NEAR(s.std, std::sqrt(3.5), 1e-12);
  EXPECT_DOUBLE_EQ(s.max, 6);
  EXPECT_EQ(statistics({}).mean, 0);
}

}  // namespace
}  // namespace helicoid
