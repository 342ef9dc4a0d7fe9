#include "helicoid/eval/coverage.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

constexpr int kDraws = 20000;
/// Four standard deviations of a share of 95 % over so many draws, per cent.
constexpr double kChance = 0.62;

Matrix3d random_covariance(Random& random) {
  Matrix3d A;
  for (double& a : A.reshaped()) a = 0.01 * random.normal();
  return A * A.transpose() + 1e-5 * Matrix3d::Identity();
}

/// The true pose, if the stated one's covariance is `covariance`.
Pose2 draw_truth(Random& random, const Pose2& stated, const Matrix3d& covariance) {
  const Matrix3d L = covariance.llt().matrixL();
  return Pose2::from_vector(stated.vector() + L * Vector3d(random.normal(), random.normal(), random.normal()));
}

Pose2 random_pose(Random& random) {
  return {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3.14, 3.14)};
}

TEST(Coverage, OfHonestCovariancesIsNinetyFivePerCentInEveryComponentAndTogether) {
  Random random(1);
  Coverage coverage;
  for (int i = 0; i < kDraws; ++i) {
    const UncertainPose2 stated{random_pose(random), random_covariance(random)};
    coverage.add(stated, draw_truth(random, stated.T_a_b, stated.covariance));
  }
  EXPECT_NEAR(coverage.nees_per_freedom(), 1, 0.03);
  EXPECT_NEAR(coverage.region_percent(), 95, kChance);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(coverage.inside_percent(k), 95, kChance);
}

TEST(Coverage, SeesCovariancesThatAreTooSmall) {
  Random random(2);
  Coverage coverage;
  for (int i = 0; i < kDraws; ++i) {
    const UncertainPose2 stated{random_pose(random), random_covariance(random)};
    coverage.add(stated, draw_truth(random, stated.T_a_b, 4 * stated.covariance));
  }
  EXPECT_NEAR(coverage.nees_per_freedom(), 4, 0.12);
  // Half of the standard deviation: +-0.98 of a normal, and a quarter of the squared limit of chi^2.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(coverage.inside_percent(k), 67.3, 1.4);
  EXPECT_NEAR(coverage.region_percent(), 41.8, 1.5);
}

TEST(Coverage, SeesCovariancesInTheFrameOfTheWrongEnd) {
  Random random(3);
  Coverage right;
  Coverage wrong;
  for (int i = 0; i < kDraws; ++i) {
    const Pose2 T_a_b{1, 0, radians(90)};
    const Matrix3d in_b = Vector3d(4e-4, 1e-6, 1e-6).asDiagonal();
    const Matrix3d in_a = turned(in_b, T_a_b.yaw);
    const Pose2 truth = draw_truth(random, T_a_b, in_a);
    right.add({T_a_b, in_a}, truth);
    wrong.add({T_a_b, in_b}, truth);
  }
  EXPECT_NEAR(right.region_percent(), 95, kChance);
  EXPECT_LT(wrong.region_percent(), 20);
}

TEST(Coverage, OfEndsThatShareAnErrorComesFromTheirOwnCovarianceNotFromTheSumOfTwo) {
  // Two poses by one shared error and one each: what is shared cancels in the pose of one relative to the other.
  Random random(4);
  const Matrix3d own = Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  Coverage coverage;
  for (int i = 0; i < kDraws; ++i) {
    const Pose2 T_w_a = random_pose(random);
    const Pose2 T_w_b = random_pose(random);
    const Pose2 shared = draw_truth(random, {}, 0.01 * Matrix3d::Identity());
    const Pose2 a = shared * T_w_a * draw_truth(random, {}, own);
    const Pose2 b = shared * T_w_b * draw_truth(random, {}, own);
    const Pose2 T_a_b = T_w_a.inverse() * T_w_b;
    const UncertainPose2 stated = compound(compound(invert({{}, own}), {T_a_b, Matrix3d::Zero()}), {{}, own});
    coverage.add(stated, a.inverse() * b);
  }
  EXPECT_NEAR(coverage.nees_per_freedom(), 1, 0.03);
  EXPECT_NEAR(coverage.region_percent(), 95, kChance);
}

TEST(Coverage, OfNothingIsNothing) {
  const Coverage coverage;
  EXPECT_EQ(coverage.count(), 0U);
  EXPECT_EQ(coverage.region_percent(), 0);
  EXPECT_EQ(coverage.nees_per_freedom(), 0);
}

}  // namespace
}  // namespace helicoid
