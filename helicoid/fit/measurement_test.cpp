#include "helicoid/fit/measurement.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/random_graph.hpp"

namespace helicoid {

namespace {

struct Kind {
  const char* name;
  std::function<Measurement(Random&)> make;
};

Vector2d random_point(Random& random) {
  return {random.uniform(-4, 4), random.uniform(-4, 4)};
}

const PairForm& any_form() {
  static const PairForm form = [] {
    Random random(17);
    PairForm f;
    for (int k = 0; k < 40; ++k) {
      const double direction = random.uniform(-3, 3);
      const Vector2d normal(std::cos(direction), std::sin(direction));
      f.add(point_line_row(random_point(random), random_point(random), normal), random.uniform(1, 9));
    }
    return f;
  }();
  return form;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"pose-pose",
       [](Random& r) {
         return PosePose{random_pose(r, 3), random_information(r)};
       }},
      {"correspondences",
       [](Random&) {
         return Correspondences{&any_form(), 0.125, 0};
       }},
      {"range",
       [](Random& r) {
         return RelativeRange{random_point(r), random_point(r), r.uniform(1, 5), 0.1};
       }},
      {"bearing",
       [](Random& r) {
         return RelativeBearing{random_point(r), random_point(r), r.uniform(-3, 3), 0.05};
       }},
      {"point", [](Random& r) {
         return PointPosition{random_point(r), Matrix2d(random_information(r).topLeftCorner<2, 2>())};
       }}};
  return all;
}

double cost_at(const Measurement& m, const Vector3d& v) {
  return cost(m, RelativePose::of({v[0], v[1], v[2]}));
}

}  // namespace

TEST(Measurement, GradientsAreThoseOfTheCost) {
  Random random(3);
  constexpr double kStep = 1e-5;
  for (const Kind& kind : kinds()) {
    for (int k = 0; k < 50; ++k) {
      const Measurement m = kind.make(random);
      const Vector3d at = random_pose(random, 5).vector();
      const PairExpansion e = expand(m, RelativePose::of({at[0], at[1], at[2]}));
      for (int i = 0; i < 3; ++i) {
        const Vector3d step = kStep * Vector3d::Unit(i);
        const double numeric = (cost_at(m, at + step) - cost_at(m, at - step)) / (2 * kStep);
        EXPECT_NEAR(e.gradient[i], numeric, 1e-5 * (1 + std::abs(numeric) + e.cost)) << kind.name;
      }
    }
  }
}

TEST(Measurement, TheExpectedInformationIsTheCurvatureWhereTheResidualVanishes) {
  Random random(4);
  for (int k = 0; k < 50; ++k) {
    const Pose2 T = random_pose(random, 5);
    const Vector2d p_a = random_point(random);
    const Vector2d p_b = random_point(random);
    const Vector2d offset = T * p_b - p_a;
    const Measurement exact[] = {PosePose{T, random_information(random)}, RelativeRange{p_a, p_b, offset.norm(), 0.2},
                                 RelativeBearing{p_a, p_b, std::atan2(offset.y(), offset.x()), 0.1},
                                 PointPosition{T.translation(), Matrix2d::Identity()}};
    for (const Measurement& m : exact) {
      const PairExpansion e = expand(m, RelativePose::of(T));
      EXPECT_NEAR(e.cost, 0, 1e-18);
      constexpr double kStep = 1e-4;
      for (int i = 0; i < 3; ++i) {
        const Vector3d step = kStep * Vector3d::Unit(i);
        const double twice = 2 * cost_at(m, T.vector() + step) / (kStep * kStep);
        const double back = 2 * cost_at(m, T.vector() - step) / (kStep * kStep);
        EXPECT_NEAR(e.information(i, i), 0.5 * (twice + back), 1e-4 * (1 + e.information(i, i)));
      }
    }
  }
}

TEST(Measurement, TheInformationIsPositiveSemiDefinite) {
  Random random(5);
  for (const Kind& kind : kinds()) {
    for (int k = 0; k < 20; ++k) {
      const PairExpansion e = expand(kind.make(random), RelativePose::of(random_pose(random, 5)));
      for (int i = 0; i < 10; ++i) {
        const Vector3d v(random.normal(), random.normal(), random.normal());
        EXPECT_GE(v.dot(e.information * v), -1e-9) << kind.name;
      }
    }
  }
}

TEST(Measurement, AnglesWrapSoThatATurnMoreIsNoError) {
  const double pi = std::numbers::pi;
  const PosePose m{{1, 2, pi - 0.01}, Matrix3d::Identity()};
  EXPECT_NEAR(cost(m, RelativePose::of({1, 2, -pi + 0.01})), 0.5 * 0.02 * 0.02, 1e-12);
  const RelativeBearing bearing{{0, 0}, {0, 0}, pi - 0.01, 1};
  EXPECT_NEAR(cost(bearing, RelativePose::of({-1, -0.01, 0})), 0.5 * 0.02 * 0.02, 1e-5);
}

TEST(Measurement, TwoPointsThatCoincideTellNoDirection) {
  for (const Measurement& m :
       {Measurement(RelativeRange{{1, 1}, {0, 0}, 2, 1}), Measurement(RelativeBearing{{1, 1}, {0, 0}, 2, 1})}) {
    const PairExpansion e = expand(m, RelativePose::of({1, 1, 0.3}));
    EXPECT_TRUE(std::isfinite(e.cost));
    EXPECT_EQ(e.gradient.norm(), 0);
    EXPECT_EQ(e.information.norm(), 0);
  }
}

// Acceptance: K correspondences and their five-by-five form are one.
TEST(Measurement, AFormIsTheSumOfItsCorrespondencesForAnyNumber) {
  Random random(6);
  for (const int count : {1, 10, 100, 1000, 10000}) {
    PairForm form;
    std::vector<std::pair<Vector5d, double>> rows;
    for (int k = 0; k < count; ++k) {
      const double direction = random.uniform(-3, 3);
      const Vector2d n(std::cos(direction), std::sin(direction));
      const Vector5d g = k % 3 == 0 ? point_point_rows(random_point(random), random_point(random))[0]
                                    : point_line_row(random_point(random), random_point(random), n);
      const double weight = random.uniform(1, 100);
      form.add(g, weight);
      rows.emplace_back(g, weight);
    }
    for (int trial = 0; trial < 5; ++trial) {
      const Pose2 T = random_pose(random, 5);
      const Vector5d v = pair_vector(T);
      const Eigen::Matrix<double, 5, 3> J = pair_vector_jacobian(T);
      PairExpansion sum;
      for (const auto& [g, weight] : rows) {
        const double e = g.dot(v);
        const Vector3d by = J.transpose() * g;
        sum.cost += 0.5 * weight * e * e;
        sum.gradient += weight * e * by;
        sum.information += weight * by * by.transpose();
      }
      const PairExpansion whole = expand(form, T);
      EXPECT_NEAR(whole.cost, sum.cost, 1e-10 * sum.cost);
      EXPECT_LT((whole.gradient - sum.gradient).norm(), 1e-10 * sum.gradient.norm() + 1e-10);
      EXPECT_LT((whole.information - sum.information).norm(), 1e-10 * sum.information.norm());
    }
  }
}

}  // namespace helicoid
