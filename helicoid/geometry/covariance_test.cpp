#include "helicoid/geometry/covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

Matrix3d random_covariance(Random& random, double size) {
  Matrix3d A;
  for (double& a : A.reshaped()) a = size * random.normal();
  return A * A.transpose() + 0.1 * size * size * Matrix3d::Identity();
}

UncertainPose2 random_pose(Random& random, double size) {
  return {{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3.14, 3.14)}, random_covariance(random, size)};
}

Pose2 draw(Random& random, const UncertainPose2& from) {
  const Matrix3d L = from.covariance.llt().matrixL();
  return Pose2::from_vector(from.T_a_b.vector() + L * Vector3d(random.normal(), random.normal(), random.normal()));
}

/// The covariance of draws about their true value.
template <class Draw>
Matrix3d sampled(const Pose2& about, int count, Draw&& next) {
  Matrix3d sum = Matrix3d::Zero();
  for (int i = 0; i < count; ++i) {
    const Pose2 drawn = next();
    const Vector3d off(drawn.x - about.x, drawn.y - about.y, wrap_angle(drawn.yaw - about.yaw));
    sum += off * off.transpose() / count;
  }
  return sum;
}

/// As variances of the same quantities: in units of the expected ones.
void expect_alike(const Matrix3d& sample, const Matrix3d& expected, double tolerance) {
  const Matrix3d L = expected.llt().matrixL();
  const Matrix3d whitened = L.inverse() * sample * L.transpose().inverse();
  const Vector3d ratios = Eigen::SelfAdjointEigenSolver<Matrix3d>(whitened).eigenvalues();
  EXPECT_NEAR(ratios.minCoeff(), 1, tolerance);
  EXPECT_NEAR(ratios.maxCoeff(), 1, tolerance);
}

// 40 000 draws tell a variance to 0.7 %; errors are small enough for the linear law to hold.
constexpr int kDraws = 40000;
constexpr double kSampling = 0.03;

TEST(Covariance, CompoundIsWhatMonteCarloFinds) {
  Random random(1);
  for (int i = 0; i < 5; ++i) {
    const UncertainPose2 ab = random_pose(random, 0.001);
    const UncertainPose2 bc = random_pose(random, 0.001);
    const UncertainPose2 ac = compound(ab, bc);
    const Matrix3d sample = sampled(ac.T_a_b, kDraws, [&] { return draw(random, ab) * draw(random, bc); });
    expect_alike(sample, ac.covariance, kSampling);
  }
}

TEST(Covariance, InversionIsWhatMonteCarloFinds) {
  Random random(2);
  for (int i = 0; i < 5; ++i) {
    const UncertainPose2 ab = random_pose(random, 0.001);
    const UncertainPose2 ba = invert(ab);
    const Matrix3d sample = sampled(ba.T_a_b, kDraws, [&] { return draw(random, ab).inverse(); });
    expect_alike(sample, ba.covariance, kSampling);
  }
}

TEST(Covariance, InvertingTwiceChangesNothing) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const UncertainPose2 ab = random_pose(random, 1);
    EXPECT_TRUE(invert(invert(ab)).covariance.isApprox(ab.covariance, 1e-9));
  }
}

TEST(Covariance, CompoundIsAssociative) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const UncertainPose2 a = random_pose(random, 1), b = random_pose(random, 1), c = random_pose(random, 1);
    EXPECT_TRUE(compound(compound(a, b), c).covariance.isApprox(compound(a, compound(b, c)).covariance, 1e-9));
  }
}

TEST(Covariance, CompoundWithACertainIdentityChangesNothing) {
  Random random(5);
  const UncertainPose2 certain;
  for (int i = 0; i < 100; ++i) {
    const UncertainPose2 ab = random_pose(random, 1);
    EXPECT_TRUE(compound(ab, certain).covariance.isApprox(ab.covariance, 1e-12));
    EXPECT_TRUE(compound(certain, ab).covariance.isApprox(ab.covariance, 1e-12));
  }
}

TEST(Covariance, TransportIsSymmetricToTheBitAndKeepsPositiveDefiniteness) {
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Composition c = compose_with_jacobians(random_pose(random, 1).T_a_b, random_pose(random, 1).T_a_b);
    const Matrix3d moved = transport(c.by_first, random_covariance(random, 0.1));
    EXPECT_EQ(moved, Matrix3d(moved.transpose()));
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix3d>(moved).eigenvalues().minCoeff(), 0);
  }
}

TEST(ConfidenceInterval, IsTheLargestAxisOfThePositionAndTheHeadingApart) {
  Matrix3d covariance = Matrix3d::Zero();
  // An ellipse with half-axes 0.3 and 0.1 m, turned by 30 degrees.
  const Matrix2d R = Pose2{0, 0, radians(30)}.rotation();
  covariance.topLeftCorner<2, 2>() = R * Eigen::Vector2d(0.09, 0.01).asDiagonal() * R.transpose();
  covariance(2, 2) = 0.0004;
  const ConfidenceInterval interval = confidence_interval(covariance);
  EXPECT_NEAR(interval.position, 1.96 * 0.3, 1e-12);
  EXPECT_NEAR(interval.heading, 1.96 * 0.02, 1e-12);
}

TEST(ConfidenceInterval, DoesNotTurnWithTheFrame) {
  Random random(7);
  for (int i = 0; i < 50; ++i) {
    const Matrix3d covariance = random_covariance(random, 0.1);
    Matrix3d turn = Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = Pose2{0, 0, random.uniform(-3, 3)}.rotation();
    EXPECT_NEAR(confidence_interval(transport(turn, covariance)).position, confidence_interval(covariance).position,
                1e-12);
  }
}

TEST(ConfidenceInterval, OfCertaintyIsZero) {
  const ConfidenceInterval interval = confidence_interval(Matrix3d::Zero());
  EXPECT_EQ(interval.position, 0);
  EXPECT_EQ(interval.heading, 0);
}

}  // namespace
}  // namespace helicoid
