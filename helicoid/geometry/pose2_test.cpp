#include "helicoid/geometry/pose2.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

constexpr double kPi = std::numbers::pi;

/// Identity, near-singular (turns of about +-pi and 0, tiny and far) and random poses.
std::vector<Pose2> poses(std::uint64_t seed, int random_count) {
  std::vector<Pose2> all{{}, {1, 2, 0}, {0, 0, 1}};
  for (const double yaw :
       {-kPi, std::nextafter(kPi, 0), -kPi + 1e-9, kPi - 1e-9, 1e-9, -1e-12, 0.5 * kPi, -0.5 * kPi}) {
    all.push_back({0.3, -0.7, yaw});
    all.push_back({1e-9, 1e-9, yaw});
    all.push_back({1e4, -1e4, yaw});
  }
  Random random(seed);
  for (int i = 0; i < random_count; ++i) {
    all.push_back({random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-kPi, kPi)});
  }
  return all;
}

void expect_equal(const Pose2& a, const Pose2& b, double tolerance = 1e-11) {
  const double scale = 1 + a.distance() + b.distance();
  EXPECT_NEAR(a.x, b.x, tolerance * scale);
  EXPECT_NEAR(a.y, b.y, tolerance * scale);
  EXPECT_NEAR(wrap_angle(a.yaw - b.yaw), 0, tolerance);
}

TEST(WrapAngle, LiesWithinMinusPiAndPiAndIsTheSameDirection) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const double angle = random.uniform(-100, 100);
    const double wrapped = wrap_angle(angle);
    ASSERT_GE(wrapped, -kPi);
    ASSERT_LT(wrapped, kPi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
    EXPECT_EQ(wrap_angle(wrapped), wrapped);
  }
}

TEST(WrapAngle, TurnsPlusPiIntoMinusPiAndKeepsMinusPi) {
  EXPECT_EQ(wrap_angle(kPi), -kPi);
  EXPECT_EQ(wrap_angle(-kPi), -kPi);
  EXPECT_EQ(wrap_angle(3 * kPi), -kPi);
  EXPECT_EQ(wrap_angle(0), 0);
  for (const double angle : {std::nextafter(kPi, 4), std::nextafter(-kPi, -4), std::nextafter(kPi, 0), 1e9, -1e9}) {
    EXPECT_GE(wrap_angle(angle), -kPi);
    EXPECT_LT(wrap_angle(angle), kPi);
  }
}

TEST(Pose2, InverseUndoesComposition) {
  for (const Pose2& a : poses(2, 200)) {
    expect_equal(a * a.inverse(), {});
    expect_equal(a.inverse() * a, {});
    expect_equal(a.inverse().inverse(), a);
  }
}

TEST(Pose2, CompositionIsAssociative) {
  const std::vector<Pose2> all = poses(3, 30);
  for (const Pose2& a : all) {
    for (const Pose2& b : all) {
      for (std::size_t k = 0; k < all.size(); k += 5) expect_equal((a * b) * all[k], a * (b * all[k]), 1e-10);
    }
  }
}

TEST(Pose2, TheIdentityIsNeutral) {
  for (const Pose2& a : poses(4, 100)) {
    expect_equal(a * Pose2{}, a);
    expect_equal(Pose2{} * a, a);
  }
}

TEST(Pose2, CompositionActsOnPointsOneAfterTheOther) {
  Random random(5);
  const std::vector<Pose2> all = poses(5, 50);
  for (const Pose2& a : all) {
    const Pose2& b = all[random.below(all.size())];
    const Vector2d p(random.uniform(-9, 9), random.uniform(-9, 9));
    EXPECT_LT((((a * b) * p) - (a * (b * p))).norm(), 1e-11 * (1 + a.distance() + b.distance()));
    EXPECT_LT(((a * p) - (a.rotation() * p + a.translation())).norm(), 1e-11 * (1 + a.distance()));
  }
}

TEST(Pose2, ThePapersOperatorsUndoEachOther) {
  const std::vector<Pose2> all = poses(6, 60);
  for (const Pose2& r : all) {
    for (const Pose2& theta : all) {
      expect_equal(ominus(oplus(r, theta), theta), r, 1e-10);
      expect_equal(oplus(ominus(r, theta), theta), r, 1e-10);
    }
  }
}

/// Central differences of a function of a pose's three parameters.
template <class Function>
Matrix3d numeric_jacobian(const Pose2& at, Function&& f) {
  constexpr double kStep = 1e-6;
  Matrix3d J;
  for (int i = 0; i < 3; ++i) {
    const auto moved = [&](double step) {
      Vector3d v = at.vector();
      v[i] += step;
      return f(Pose2{v[0], v[1], v[2]});
    };
    const Pose2 high = moved(kStep);
    const Pose2 low = moved(-kStep);
    J.col(i) = Vector3d(high.x - low.x, high.y - low.y, wrap_angle(high.yaw - low.yaw)) / (2 * kStep);
  }
  return J;
}

TEST(Pose2, JacobiansOfCompositionAreItsDerivatives) {
  Random random(7);
  const std::vector<Pose2> all = poses(7, 60);
  for (const Pose2& a : all) {
    const Pose2& b = all[random.below(all.size())];
    const Composition c = compose_with_jacobians(a, b);
    expect_equal(c.T_a_c, a * b);
    const double tolerance = 1e-8 * (1 + a.distance() + b.distance());
    EXPECT_TRUE(c.by_first.isApprox(numeric_jacobian(a, [&](const Pose2& m) { return m * b; }), tolerance));
    EXPECT_TRUE(c.by_second.isApprox(numeric_jacobian(b, [&](const Pose2& m) { return a * m; }), tolerance));
  }
}

TEST(Pose2, TheJacobianOfInversionIsItsDerivative) {
  for (const Pose2& a : poses(8, 60)) {
    const Inversion inverse = invert_with_jacobian(a);
    expect_equal(inverse.T_b_a, a.inverse());
    const double tolerance = 1e-8 * (1 + a.distance());
    EXPECT_TRUE(inverse.by_pose.isApprox(numeric_jacobian(a, [](const Pose2& m) { return m.inverse(); }), tolerance));
  }
}

TEST(Exponential, AddsUpAlongOneTwist) {
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    // Some twists turn hardly at all: there the series takes over.
    const double turn = i % 3 == 0 ? std::pow(10, random.uniform(-12, -2)) : random.uniform(-3, 3);
    const Vector3d twist(random.uniform(-2, 2), random.uniform(-2, 2), turn);
    expect_equal(exponential(0.5 * twist) * exponential(0.5 * twist), exponential(twist));
    expect_equal(exponential(-twist), exponential(twist).inverse());
  }
  expect_equal(exponential(Vector3d::Zero()), {});
}

TEST(Exponential, IsUndoneByTheLogarithm) {
  for (const Pose2& a : poses(10, 200)) {
    expect_equal(exponential(logarithm(a)), a, 1e-9);
    EXPECT_LE(std::abs(logarithm(a)[2]), kPi);
  }
  EXPECT_EQ(logarithm({}), Vector3d::Zero());
}

TEST(Exponential, HasNoStepWhereTheSeriesTakesOver) {
  const Vector3d below(1, -2, std::sqrt(1e-8) * (1 - 1e-9));
  const Vector3d above(1, -2, std::sqrt(1e-8) * (1 + 1e-9));
  EXPECT_LT((exponential(below).vector() - exponential(above).vector()).norm(), 1e-11);
}

TEST(Exponential, GoesRoundACircle) {
  // A quarter of a circle of radius 2: forward by its length, turning left.
  const Pose2 quarter = exponential({kPi, 0, 0.5 * kPi});
  expect_equal(quarter, {2, 2, 0.5 * kPi});
}

}  // namespace
}  // namespace helicoid
