#include "helicoid/fit/robust_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "helicoid/fit/consistent_start.hpp"
#include "helicoid/fit/initial_guess.hpp"
#include "helicoid/fit/innovation.hpp"
#include "tests/random_graph.hpp"

namespace helicoid {

namespace {

constexpr LossKind kKinds[] = {LossKind::quadratic, LossKind::huber, LossKind::cauchy, LossKind::truncated};

/// As many wrong closures as right ones, the wrong ones at the end.
RelationGraph with_wrong_closures(RelationGraph graph, std::uint64_t seed, std::size_t wrong) {
  Random random(seed);
  const auto count = static_cast<std::uint32_t>(graph.poses.size());
  const auto any = [&] { return static_cast<std::uint32_t>(random.below(count)); };
  for (std::size_t k = 0; k < wrong; ++k) {
    const std::uint32_t a = any();
    const std::uint32_t b = (a + 2 + any() % (count - 3)) % count;
    graph.relations.push_back({a, b, PosePose{random_pose(random, 10), random_information(random)}, true});
  }
  return graph;
}

}  // namespace

TEST(RobustLoss, TheWeightIsTheSlopeOfTheLoss) {
  for (const LossKind kind : kKinds) {
    for (const double softness : {0.0, 0.3, 2.0}) {
      const RobustLoss loss{kind, 3, softness};
      for (double chi2 = 0.05; chi2 < 60; chi2 += 0.37) {
        const double numeric = (evaluate(loss, chi2 + 1e-6).value - evaluate(loss, chi2 - 1e-6).value) / 2e-6;
        EXPECT_NEAR(evaluate(loss, chi2).weight, numeric, 1e-6) << "chi2 " << chi2;
      }
    }
  }
}

TEST(RobustLoss, NeverExceedsTheQuadraticOneAndNeverFalls) {
  for (const LossKind kind : kKinds) {
    double last = 0;
    for (double chi2 = 0; chi2 < 60; chi2 += 0.1) {
      const double value = evaluate({kind, 3, 0}, chi2).value;
      EXPECT_LE(value, chi2 + 1e-12);
      EXPECT_GE(value, last);
      last = value;
    }
  }
}

TEST(RobustFit, WithoutWrongRelationsItIsThePlainOptimum) {
  const RelationGraph graph = random_graph(21, 60, 60);
  FitOptions options;
  options.loss = {LossKind::truncated, 8, 0};
  const RobustFit robust = fit_robustly(graph, default_gauge(graph), options);
  const FitResult plain = fit(graph);
  EXPECT_NEAR(robust.result.final_cost, plain.final_cost, 1e-6 * plain.final_cost);
  EXPECT_TRUE(robust.wrong.empty());
}

TEST(RobustFit, LetsEveryWrongClosureGoWhereHalfOfThemAreWrong) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    RelationGraph clean = random_graph(seed, 120, 60);
    // All as well known as they were measured: a chain that is looser would agree with wrong closures by chance.
    for (GraphRelation& r : clean.relations) {
      std::get<PosePose>(r.measurement).information = Vector3d(2500, 2500, 10000).asDiagonal();
    }
    clean.poses = odometry_start(clean);
    std::size_t right = 0;
    for (const GraphRelation& r : clean.relations) right += r.may_be_wrong ? 1 : 0;
    const RelationGraph graph = with_wrong_closures(clean, seed, right);
    FitOptions options;
    options.loss = {LossKind::truncated, 8, 0};
    const RobustFit robust = fit_robustly(graph, default_gauge(graph), options);
    std::size_t found = 0;
    for (const std::uint32_t i : robust.wrong) found += i >= clean.relations.size() ? 1 : 0;
    EXPECT_EQ(found, right) << "seed " << seed;
  }
}

TEST(RobustFit, LetsWrongClosuresGoThoughTheyAgreeWithOneAnother) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    RelationGraph graph = random_graph(seed, 150, 60);
    const std::size_t right = graph.relations.size();
    // A stretch of ten poses seen twice where it is not: all ten say the same.
    const Pose2 wrong{2, -1, 0.7};
    for (std::uint32_t k = 0; k < 10; ++k) {
      const Pose2 T_a = graph.poses[20].inverse() * graph.poses[20 + k];
      const Pose2 T_b = graph.poses[100].inverse() * graph.poses[100 + k];
      graph.relations.push_back(
          {20 + k, 100 + k, PosePose{T_a.inverse() * wrong * T_b, 400 * Matrix3d::Identity()}, true});
    }
    FitOptions options;
    options.loss.kind = LossKind::truncated;
    const RobustFit robust = fit_robustly(graph, default_gauge(graph), options);
    std::vector<std::uint32_t> expected(10);
    std::iota(expected.begin(), expected.end(), static_cast<std::uint32_t>(right));
    EXPECT_EQ(robust.wrong, expected) << "seed " << seed;
  }
}

TEST(RobustFit, NoChangeOfSidesOfOneRelationLowersTheTruncatedCost) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const RelationGraph clean = random_graph(seed, 60, 40);
    const RelationGraph graph = with_wrong_closures(clean, seed, 40);
    FitOptions options;
    options.loss.kind = LossKind::truncated;
    const std::vector<std::uint32_t> gauge = default_gauge(graph);
    const RobustFit robust = fit_robustly(graph, gauge, options);
    std::vector<bool> kept(graph.relations.size(), true);
    for (const std::uint32_t i : robust.wrong) kept[i] = false;
    const auto cost_of = [&](const std::vector<bool>& taken) {
      const auto out = static_cast<double>(std::count(taken.begin(), taken.end(), false));
      const FittedPart part(graph, taken, robust.result.poses, gauge, {});
      return part.cost() + 0.5 * robust.width * robust.width * out;
    };
    const double least = cost_of(kept);
    EXPECT_NEAR(least, robust.result.final_cost, 1e-6 * least);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (!graph.relations[i].may_be_wrong) continue;
      kept[i] = !kept[i];
      EXPECT_GT(cost_of(kept), least * (1 - 1e-6)) << "relation " << i;
      kept[i] = !kept[i];
    }
  }
}

TEST(ConsistentStart, TrustedRelationsThatLeaveAPoseOpenAreSaid) {
  RelationGraph graph = random_graph(3, 10, 0);
  for (GraphRelation& r : graph.relations) r.may_be_wrong = true;
  EXPECT_FALSE(consistent_start(graph, default_gauge(graph), {}).is_determined);
}

}  // namespace helicoid
