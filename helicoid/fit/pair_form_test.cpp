#include "helicoid/fit/pair_form.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <tuple>
#include <vector>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

/// A point of b on a line of a.
struct Correspondence {
  Vector2d p_b, q_a, n_a;
  double weight;
};

Pose2 random_pose(Random& random) {
  return {random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-3.14, 3.14)};
}

std::vector<Correspondence> random_correspondences(Random& random, int count, const Pose2& T_a_b, double noise) {
  std::vector<Correspondence> all;
  for (int k = 0; k < count; ++k) {
    const Vector2d p_b(random.uniform(-10, 10), random.uniform(-10, 10));
    const double direction = random.uniform(-3.14, 3.14);
    const Vector2d n_a(std::cos(direction), std::sin(direction));
    const Vector2d along(-n_a.y(), n_a.x());
    const Vector2d q_a = T_a_b * p_b + noise * random.normal() * n_a + random.uniform(-1, 1) * along;
    all.push_back({p_b, q_a, n_a, random.uniform(0.1, 1e4)});
  }
  return all;
}

/// The same by the definition: one residual after another, with its derivative.
PairExpansion expand_directly(const std::vector<Correspondence>& correspondences, const Pose2& T_a_b) {
  PairExpansion sum;
  Matrix2d turned;  // dR / dphi
  turned << -std::sin(T_a_b.yaw), -std::cos(T_a_b.yaw), std::cos(T_a_b.yaw), -std::sin(T_a_b.yaw);
  for (const Correspondence& c : correspondences) {
    const double residual = c.n_a.dot(T_a_b * c.p_b - c.q_a);
    const Vector3d J(c.n_a.x(), c.n_a.y(), c.n_a.dot(turned * c.p_b));
    sum.cost += 0.5 * c.weight * residual * residual;
    sum.gradient += c.weight * residual * J;
    sum.information += c.weight * J * J.transpose();
  }
  return sum;
}

PairForm form_of(const std::vector<Correspondence>& correspondences) {
  PairForm form;
  for (const Correspondence& c : correspondences) form.add(point_line_row(c.p_b, c.q_a, c.n_a), c.weight);
  return form;
}

void expect_equal(const PairExpansion& a, const PairExpansion& b) {
  EXPECT_NEAR(a.cost, b.cost, 1e-10 * b.cost);
  EXPECT_LE((a.gradient - b.gradient).norm(), 1e-10 * b.gradient.norm());
  EXPECT_LE((a.information - b.information).norm(), 1e-10 * b.information.norm());
}

TEST(PairForm, EqualsItsCorrespondencesWhateverTheirNumber) {
  Random random(1);
  for (const int count : {1, 2, 3, 10, 100, 1000, 10000}) {
    SCOPED_TRACE(count);
    for (int i = 0; i < 10; ++i) {
      const Pose2 T_a_b = random_pose(random);
      const std::vector<Correspondence> all = random_correspondences(random, count, T_a_b, 0.2);
      // Away from the minimum: there the gradient is a difference of large sums and has no digits to compare.
      const Pose2 at = T_a_b * Pose2{0.3, -0.2, 0.1};
      const PairExpansion e = expand(form_of(all), at);
      expect_equal(e, expand_directly(all, at));
      EXPECT_NEAR(form_of(all).cost(at), e.cost, 1e-12 * e.cost);
    }
  }
}

TEST(PairForm, EqualsItsCorrespondencesFarFromWhereTheyWereMatched) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const std::vector<Correspondence> all = random_correspondences(random, 100, random_pose(random), 0.02);
    const Pose2 elsewhere = random_pose(random);
    expect_equal(expand(form_of(all), elsewhere), expand_directly(all, elsewhere));
  }
}

/// Segments of b and the lines of a that they lie on, nearly.
std::vector<std::pair<LineSegment, LineSegment>> random_lines(Random& random, int count, const Pose2& T_a_b) {
  std::vector<std::pair<LineSegment, LineSegment>> all;
  for (int k = 0; k < count; ++k) {
    const auto segment = [&random](const Vector2d& middle, double direction, double half) {
      const Vector2d along(std::cos(direction), std::sin(direction));
      return LineSegment{middle - half * along, middle + half * along, {-along.y(), along.x()}};
    };
    const Vector2d middle(random.uniform(-10, 10), random.uniform(-10, 10));
    const double direction = random.uniform(-3.14, 3.14);
    const Vector2d near(0.1 * random.normal(), 0.1 * random.normal());
    all.emplace_back(segment(middle, direction, random.uniform(0.2, 3)),
                     segment(T_a_b * middle + near, direction + T_a_b.yaw + 0.05 * random.normal(), 2));
  }
  return all;
}

TEST(PairForm, EqualsItsLinesWhateverTheirNumber) {
  constexpr double kWeights[] = {400, 400, 1e4};  // 1/m^2, 1/m^2, 1/rad^2
  Random random(9);
  for (const int count : {1, 2, 3, 10, 100, 1000, 10000}) {
    SCOPED_TRACE(count);
    const Pose2 T_a_b = random_pose(random);
    const Pose2 at = T_a_b * Pose2{0.3, -0.2, 0.1};
    PairForm form;
    PairExpansion direct;
    for (const auto& [line_b, line_a] : random_lines(random, count, T_a_b)) {
      const std::array<Vector5d, 3> rows = line_line_rows(line_b, line_a);
      for (std::size_t i = 0; i < 3; ++i) form.add(rows[i], kWeights[i]);
      const PairExpansion ends = expand_directly(
          {{line_b.start, line_a.start, line_a.normal, 400}, {line_b.end, line_a.start, line_a.normal, 400}}, at);
      // By the angle itself: the direction of the normals, and how its sine changes.
      const double angle =
          at.yaw + std::atan2(line_b.normal.y(), line_b.normal.x()) - std::atan2(line_a.normal.y(), line_a.normal.x());
      const Vector3d J(0, 0, std::cos(angle));
      direct.cost += ends.cost + 0.5 * 1e4 * std::sin(angle) * std::sin(angle);
      direct.gradient += ends.gradient + 1e4 * std::sin(angle) * J;
      direct.information += ends.information + 1e4 * J * J.transpose();
    }
    expect_equal(expand(form, at), direct);
  }
}

TEST(PairForm, OfALineItsLengthwisePositionIsOpen) {
  const LineSegment wall{{-1, 2}, {3, 2}, Vector2d::UnitY()};
  PairForm form;
  for (const Vector5d& g : line_line_rows(wall, wall)) form.add(g, 1);
  EXPECT_NEAR(form.cost({5, 0, 0}), 0, 1e-15);
  EXPECT_GT(form.cost({0, 0.1, 0}), 1e-3);
  EXPECT_GT(form.cost({0, 0, 0.1}), 1e-3);
}

TEST(NormalsAgree, OnlyWhereBothSawTheSameSide) {
  const LineSegment wall{{-1, 2}, {3, 2}, Vector2d::UnitY()};
  const LineSegment back{{-1, 2}, {3, 2}, -Vector2d::UnitY()};
  EXPECT_TRUE(normals_agree({4, 1, 0.3}, wall, wall));
  EXPECT_FALSE(normals_agree({4, 1, 0.3}, back, wall));
  EXPECT_TRUE(normals_agree({4, 1, 3}, back, wall));
}

TEST(PairForm, PointToPointIsTheSquaredDistance) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Pose2 T_a_b = random_pose(random);
    const Vector2d p_b(random.uniform(-10, 10), random.uniform(-10, 10));
    const Vector2d q_a(random.uniform(-10, 10), random.uniform(-10, 10));
    PairForm form;
    for (const Vector5d& g : point_point_rows(p_b, q_a)) form.add(g, 2);
    EXPECT_NEAR(form.cost(T_a_b), (T_a_b * p_b - q_a).squaredNorm(), 1e-10);
  }
}

TEST(PairForm, FormsAddUp) {
  Random random(4);
  const Pose2 T_a_b = random_pose(random);
  std::vector<Correspondence> some = random_correspondences(random, 40, T_a_b, 0.1);
  const std::vector<Correspondence> more = random_correspondences(random, 70, T_a_b, 0.1);
  PairForm sum = form_of(some);
  sum.M += form_of(more).M;
  some.insert(some.end(), more.begin(), more.end());
  EXPECT_TRUE(sum.M.isApprox(form_of(some).M, 1e-14));
}

TEST(PairForm, ItsInformationIsNeverNegative) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const int count = 1 + static_cast<int>(random.below(5));
    const PairExpansion e =
        expand(form_of(random_correspondences(random, count, random_pose(random), 5)), random_pose(random));
    const Vector3d eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix3d>(e.information).eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());
  }
}

TEST(PairForm, AnUnknownThatResidualsShareIsTakenOutAtItsBestValueForEveryPose) {
  Random random(17);
  constexpr double kSigma = 0.05;
  PairForm form;
  SharedUnknown shared;
  std::vector<std::tuple<Vector5d, double, double>> residuals;
  for (int k = 0; k < 30; ++k) {
    const Vector2d normal(std::cos(0.4 * k), std::sin(0.4 * k));
    const Vector5d g = point_line_row({random.normal(), random.normal()}, {random.normal(), random.normal()}, normal);
    const double h = random.uniform(-1, 1);
    const double weight = random.uniform(1, 1e3);
    form.add(g, weight);
    shared.add(g, h, weight);
    residuals.emplace_back(g, h, weight);
  }
  form.marginalise(shared, kSigma);
  for (int trial = 0; trial < 10; ++trial) {
    const Pose2 T{random.normal(), random.normal(), random.uniform(-3, 3)};
    const auto cost_with = [&](double u) {
      double cost = 0.5 * u * u / (kSigma * kSigma);
      for (const auto& [g, h, weight] : residuals) cost += 0.5 * weight * std::pow(g.dot(pair_vector(T)) + h * u, 2);
      return cost;
    };
    // A parabola: its least value by three points of it.
    const double a = cost_with(-1), b = cost_with(0), c = cost_with(1);
    const double curvature = a - 2 * b + c;
    const double least = b - 0.125 * (c - a) * (c - a) / curvature;
    EXPECT_NEAR(form.cost(T), least, 1e-8 * b);
  }
}

TEST(PosePoseForm, CostsNothingWhereItWasMeasuredAndHasItsInformationThere) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const Pose2 T_a_b = random_pose(random);
    Matrix3d A;
    for (double& a : A.reshaped()) a = random.normal();
    const Matrix3d information = A * A.transpose();
    const PairExpansion e = expand(pose_pose_form(T_a_b, information), T_a_b);
    EXPECT_NEAR(e.cost, 0, 1e-12 * information.trace());
    EXPECT_NEAR(e.gradient.norm(), 0, 1e-12 * information.trace());
    EXPECT_TRUE(e.information.isApprox(information, 1e-12));
  }
}

TEST(Minimise, FindsThePoseThatCorrespondencesWereMadeFrom) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const Pose2 T_a_b = random_pose(random);
    const PairForm form = form_of(random_correspondences(random, 30, T_a_b, 0));
    const PairMinimum minimum = minimise(form, T_a_b * Pose2{0.2, -0.1, 0.15});
    EXPECT_TRUE(minimum.converged);
    const Pose2 off = T_a_b.inverse() * minimum.T_a_b;
    EXPECT_LT(off.distance() + std::abs(off.yaw), 1e-6);
  }
}

TEST(Minimise, HasNoGradientLeftAndIsNoDearerThanItsSurroundings) {
  Random random(8);
  for (int i = 0; i < 50; ++i) {
    const Pose2 T_a_b = random_pose(random);
    const PairForm form = form_of(random_correspondences(random, 50, T_a_b, 0.1));
    const PairMinimum minimum = minimise(form, T_a_b);
    const PairExpansion e = expand(form, minimum.T_a_b);
    EXPECT_LT(e.gradient.norm(), 1e-6 * e.information.norm());
    for (int k = 0; k < 20; ++k) {
      const Vector3d step = 1e-3 * Vector3d(random.normal(), random.normal(), random.normal());
      EXPECT_GE(form.cost(Pose2::from_vector(minimum.T_a_b.vector() + step)), minimum.cost);
    }
  }
}

TEST(Minimise, StaysWhereACorridorLeavesADirectionOpen) {
  PairForm corridor;
  for (int k = 0; k < 20; ++k) {
    const Vector2d p_b(0.5 * k, k % 2 == 0 ? 1 : -1);
    corridor.add(point_line_row(p_b, p_b + Vector2d(0, 0.05), Vector2d::UnitY()), 1e4);
  }
  const PairMinimum minimum = minimise(corridor, {3, 0, 0.02});
  EXPECT_NEAR(minimum.T_a_b.y, 0.05, 1e-5);
  EXPECT_NEAR(minimum.T_a_b.x, 3, 0.1);
}

TEST(Minimise, LeavesAnEmptyFormWhereItStarts) {
  const Pose2 start{1, 2, 3};
  EXPECT_EQ(minimise({}, start).T_a_b, start);
  EXPECT_EQ(minimise({}, start).cost, 0);
}

}  // namespace
}  // namespace helicoid
