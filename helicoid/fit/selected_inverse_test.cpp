// All covariances relative to one pose, by selected inversion.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "helicoid/fit/linear_system.hpp"
#include "helicoid/fit/relative_covariance.hpp"
#include "tests/random_graph.hpp"

namespace helicoid {

namespace {

/// The information with one pose held, dense, by the poses' twists.
Eigen::MatrixXd dense_information(const RelationGraph& graph, std::uint32_t held) {
  const auto unknowns = static_cast<Eigen::Index>(3 * graph.poses.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (const GraphRelation& r : graph.relations) {
    const Pose2 T_a_b = graph.poses[r.a].inverse() * graph.poses[r.b];
    const Eigen::Matrix<double, 3, 6> J = relative_jacobian(T_a_b);
    const Eigen::Matrix<double, 6, 6> M =
        J.transpose() * expand(r.measurement, RelativePose::of(T_a_b)).information * J;
    const Eigen::Index at[2] = {3 * static_cast<Eigen::Index>(r.a), 3 * static_cast<Eigen::Index>(r.b)};
    for (int k = 0; k < 2; ++k) {
      for (int l = 0; l < 2; ++l) H.block<3, 3>(at[k], at[l]) += M.block<3, 3>(3 * k, 3 * l);
    }
  }
  const Eigen::Index h = 3 * static_cast<Eigen::Index>(held);
  H.middleRows<3>(h).setZero();
  H.middleCols<3>(h).setZero();
  H.block<3, 3>(h, h).setIdentity();
  return H;
}

}  // namespace

TEST(SelectedInverse, EqualsADenseInverseForEveryPose) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const RelationGraph graph = random_graph(seed, 90, static_cast<std::uint32_t>(20 * seed));
    for (const std::uint32_t held : {0U, 41U}) {
      const Eigen::MatrixXd covariance = dense_information(graph, held).inverse();
      RelativeCovariance confidence(graph);
      const std::vector<UncertainPose2> all = confidence.relative_to(held);
      ASSERT_TRUE(confidence.is_determined());
      for (std::uint32_t b = 0; b < graph.poses.size(); ++b) {
        if (b == held) continue;
        Matrix3d turn = Matrix3d::Identity();
        turn.topLeftCorner<2, 2>() = all[b].T_a_b.rotation();
        const Matrix3d expected = turn * covariance.block<3, 3>(3 * b, 3 * b) * turn.transpose();
        EXPECT_LT((all[b].covariance - expected).norm(), 1e-8 * expected.norm());
      }
    }
  }
}

TEST(SelectedInverse, EqualsAPairsOwnRightHandSidesWhateverIsHeld) {
  const RelationGraph graph = random_graph(8, 400, 300);
  RelativeCovariance all(graph);
  const RelativeCovariance pairs(graph);
  const std::vector<UncertainPose2> relative = all.relative_to(123);
  for (const std::uint32_t b : {0U, 1U, 57U, 122U, 124U, 399U}) {
    const Matrix3d expected = pairs.of(123, b).covariance;
    EXPECT_LT((relative[b].covariance - expected).norm(), 1e-8 * expected.norm());
  }
}

TEST(SelectedInverse, APoseRelativeToItselfIsCertain) {
  RelativeCovariance confidence(random_graph(9, 30, 20));
  EXPECT_EQ(confidence.relative_to(7)[7].covariance.norm(), 0);
}

TEST(SelectedInverse, OneMoreRelationNeverMakesAPoseLessCertain) {
  RelationGraph graph = random_graph(10, 60, 20);
  RelativeCovariance before(graph);
  const std::vector<UncertainPose2> loose = before.relative_to(0);
  graph.relations.push_back({5, 50, PosePose{{}, 50 * Matrix3d::Identity()}, true});
  RelativeCovariance after(graph);
  const std::vector<UncertainPose2> tight = after.relative_to(0);
  for (std::size_t b = 0; b < loose.size(); ++b) {
    for (int i = 0; i < 3; ++i) EXPECT_LE(tight[b].covariance(i, i), loose[b].covariance(i, i) * (1 + 1e-9));
  }
}

TEST(LinearSystem, ItsGradientIsThatOfTheCostForEveryKindOfRelation) {
  Random random(12);
  RelationGraph graph = random_graph(12, 6, 4);
  graph.is_landmark.assign(8, false);
  for (std::uint32_t landmark : {6U, 7U}) {
    graph.poses.push_back({random.uniform(-3, 3), random.uniform(-3, 3), 0});
    graph.is_landmark[landmark] = true;
    graph.relations.push_back({1, landmark, PointPosition{{1, 2}, 30 * Matrix2d::Identity()}, false});
    graph.relations.push_back({3, landmark, RelativeRange{{0.1, 0}, {0, 0}, 2, 0.2}, false});
    graph.relations.push_back({4, landmark, RelativeBearing{{0.1, 0}, {0, 0}, 1, 0.1}, false});
  }
  graph.relations.push_back({kWorld, 2, PosePose{{1, 1, 1}, random_information(random)}, false});
  graph.relations.push_back({2, 5, RelativeRange{{0.1, 0.3}, {1, -1}, 2, 0.2}, true});
  for (const LossKind kind : {LossKind::quadratic, LossKind::huber, LossKind::cauchy}) {
    const RobustLoss loss{kind, 3, 0};
    LinearSystem system(graph, {});
    system.linearise(graph.poses, loss);
    const std::vector<double> gradient(system.gradient().begin(), system.gradient().end());
    constexpr double kStep = 1e-6;
    for (std::uint32_t node = 0; node < graph.poses.size(); ++node) {
      for (std::size_t i = 0; i < (graph.is_landmark[node] ? 2U : 3U); ++i) {
        std::vector<double> step(gradient.size(), 0.0);
        step[system.offset(node) + i] = 1;
        const double up = system.cost(system.moved(graph.poses, step, kStep), loss);
        const double down = system.cost(system.moved(graph.poses, step, -kStep), loss);
        const double numeric = (up - down) / (2 * kStep);
        EXPECT_NEAR(gradient[system.offset(node) + i], numeric, 1e-4 * (1 + std::abs(numeric)));
      }
    }
  }
}

}  // namespace helicoid
