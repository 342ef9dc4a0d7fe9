#include "helicoid/fit/incremental_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "helicoid/base/random.hpp"
#include "tests/random_graph.hpp"

namespace helicoid {

namespace {

PosePose noisy(const Pose2& T_a_b, Random& random) {
  const Pose2 error{0.05 * random.normal(), 0.05 * random.normal(), 0.02 * random.normal()};
  return {T_a_b * error, Vector3d(400, 400, 2500).asDiagonal()};
}

/// A robot that walks the streets of a grid and meets crossings again; each pose's relations to earlier ones.
std::vector<std::vector<GraphRelation>> walk_on_grid(std::uint64_t seed, std::uint32_t poses) {
  Random random(seed);
  std::vector<Pose2> truth{{0, 0, 0}};
  std::vector<std::vector<GraphRelation>> steps(poses);
  for (std::uint32_t i = 1; i < poses; ++i) {
    const double turn = i % 3 == 0 ? M_PI / 2 * (static_cast<double>(random.below(3)) - 1) : 0;
    truth.push_back(truth.back() * Pose2{1, 0, turn});
    steps[i].push_back({i - 1, i, noisy(truth[i - 1].inverse() * truth[i], random), false});
    for (std::uint32_t k = 0; k + 10 < i; ++k) {
      if (std::hypot(truth[k].x - truth[i].x, truth[k].y - truth[i].y) > 0.5 || random.below(3) > 0) continue;
      steps[i].push_back({k, i, noisy(truth[k].inverse() * truth[i], random), true});
    }
  }
  return steps;
}

struct Growing {
  IncrementalFit fitted;
  RelationGraph graph;  ///< the same for the batch fit
  std::size_t full_solves = 0;

  void grow(const std::vector<GraphRelation>& step) {
    Pose2 start;
    if (!step.empty()) start = fitted.pose(step.front().a) * std::get<PosePose>(step.front().measurement).T_a_b;
    const std::uint32_t node = fitted.add_pose(start);
    if (node == 0) fitted.hold(0);
    for (const GraphRelation& r : step) fitted.add_relation(r), graph.relations.push_back(r);
    const IncrementalStep done = fitted.update();
    EXPECT_TRUE(done.is_determined);
    full_solves += done.solved_fully ? 1 : 0;
  }
  double batch_cost() {
    graph.poses = fitted.poses();
    return fit(graph).final_cost;
  }
};

}  // namespace

TEST(IncrementalFit, AlongAGridTheCostIsTheBatchFitsToOnePercent) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Growing growing;
    const auto steps = walk_on_grid(seed, 1000);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      growing.grow(steps[i]);
      if (i % 100 != 99) continue;
      EXPECT_LE(growing.fitted.cost(), 1.01 * growing.batch_cost() + 1e-3) << "step " << i;
    }
  }
}

TEST(IncrementalFit, RelationsThatAreRemovedLeaveTheMapThatNeverHadThem) {
  Growing growing;
  for (const auto& step : walk_on_grid(4, 400)) growing.grow(step);
  std::vector<std::uint32_t> wrong;
  for (std::uint32_t k = 0; k < 5; ++k) {
    wrong.push_back(growing.fitted.add_relation({20 * k, 399 - 30 * k, PosePose{{3, 2, 1}, Matrix3d::Identity()}}));
    growing.fitted.update();
  }
  for (const std::uint32_t relation : wrong) growing.fitted.remove_relation(relation);
  for (int i = 0; i < 5; ++i) growing.fitted.update();
  growing.graph.poses = growing.fitted.poses();
  const FitResult batch = fit(growing.graph);
  EXPECT_LE(growing.fitted.cost(), 1.001 * batch.final_cost);
  EXPECT_LT(largest_difference(growing.fitted.poses(), batch.poses), 0.01);
}

TEST(IncrementalFit, APoseThatIsRemovedTakesItsRelationsAlong) {
  Growing growing;
  const auto steps = walk_on_grid(5, 300);
  for (const auto& step : steps) growing.grow(step);
  growing.fitted.remove_pose(299);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(growing.fitted.update().is_determined);
  Growing shorter;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) shorter.grow(steps[i]);
  for (int i = 0; i < 5; ++i) shorter.fitted.update();
  EXPECT_LT(largest_difference(shorter.fitted.poses(), growing.fitted.poses()), 0.01);
}

TEST(IncrementalFit, WhatNothingTiesDownWaitsUntilSomethingDoes) {
  IncrementalFit fitted;
  fitted.hold(fitted.add_pose({0, 0, 0}));
  fitted.add_pose({5, 5, 1});
  EXPECT_FALSE(fitted.update().is_determined);
  EXPECT_EQ(fitted.pose(1), (Pose2{5, 5, 1}));
  fitted.add_relation({0, 1, PosePose{{1, 0, 0}, Matrix3d::Identity()}});
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(fitted.update().is_determined || i > 0);
  EXPECT_NEAR(fitted.pose(1).x, 1, 1e-6);
}

TEST(IncrementalFit, AStepCostsTheSameHoweverLongTheWayBeforeIt) {
  const auto last_steps = [](std::uint32_t poses) {
    Random random(1);
    IncrementalFit fitted;
    fitted.hold(fitted.add_pose({}));
    IncrementalStep most;
    for (std::uint32_t i = 1; i < poses; ++i) {
      const PosePose odometry = noisy({1, 0, 0.1}, random);
      fitted.add_pose(fitted.pose(i - 1) * odometry.T_a_b);
      fitted.add_relation({i - 1, i, odometry, false});
      // It looks back ten poses: a short loop, each time.
      if (i > 10) fitted.add_relation({i - 10, i, noisy(fitted.pose(i - 10).inverse() * fitted.pose(i), random), true});
      const IncrementalStep step = fitted.update();
      if (i + 50 < poses) continue;
      most.eliminated = std::max(most.eliminated, step.eliminated);
      most.moved = std::max(most.moved, step.moved);
    }
    return most;
  };
  const IncrementalStep few = last_steps(200);
  const IncrementalStep many = last_steps(2000);
  EXPECT_LE(many.eliminated, 2 * few.eliminated);
  EXPECT_LE(many.moved, 2 * few.moved);
}

TEST(IncrementalFit, AFullSolveGoesOnWithTheSameGraph) {
  Growing growing;
  const auto steps = walk_on_grid(6, 300);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    growing.grow(steps[i]);
    if (i == 150) growing.fitted.solve_fully();
  }
  EXPECT_LE(growing.fitted.cost(), 1.01 * growing.batch_cost());
  const FitResult full = growing.fitted.solve_fully();
  EXPECT_EQ(full.status, FitStatus::converged);
  EXPECT_NEAR(growing.fitted.cost(), full.final_cost, 1e-6 * full.final_cost);
}

TEST(IncrementalFit, AGoodStartNeverNeedsAFullSolve) {
  Growing growing;
  for (const auto& step : walk_on_grid(3, 1000)) growing.grow(step);
  EXPECT_EQ(growing.full_solves, 0U);
}

// From far off a Gauss-Newton step overshoots: update takes it back and solves the whole graph with damping, unasked.
TEST(IncrementalFit, NoStepRaisesTheCostHoweverBadTheStart) {
  std::size_t full_solves = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Growing growing;
    Random random(seed);
    for (const auto& step : walk_on_grid(seed, 200)) {
      growing.fitted.add_pose(random_pose(random, 5));
      for (const GraphRelation& r : step) growing.fitted.add_relation(r), growing.graph.relations.push_back(r);
    }
    growing.fitted.hold(0);
    for (int k = 0; k < 20; ++k) {
      const double before = growing.fitted.cost();
      full_solves += growing.fitted.update().solved_fully ? 1 : 0;
      EXPECT_LE(growing.fitted.cost(), std::max(before + 0.5, 1.01 * before) * (1 + 1e-9)) << "seed " << seed;
    }
    EXPECT_LE(growing.fitted.cost(), 1.01 * growing.batch_cost()) << "seed " << seed;
  }
  EXPECT_GE(full_solves, 10U);
}

TEST(IncrementalFit, AfterAFullSolveThatItAskedForItselfItGoesOnWithTheSameTree) {
  Growing growing;
  const auto steps = walk_on_grid(9, 400);
  for (std::size_t i = 0; i < 200; ++i) growing.grow(steps[i]);
  // A wrong closure that turns the map over, and is taken back.
  const std::uint32_t wrong =
      growing.fitted.add_relation({0, 199, PosePose{{300, 300, 3}, Vector3d(1e6, 1e6, 1e6).asDiagonal()}, true});
  bool solved_fully = false;
  for (int k = 0; k < 5; ++k) solved_fully = growing.fitted.update().solved_fully || solved_fully;
  EXPECT_TRUE(solved_fully);
  growing.fitted.remove_relation(wrong);
  for (int k = 0; k < 5; ++k) growing.fitted.update();
  for (std::size_t i = 200; i < 400; ++i) growing.grow(steps[i]);
  EXPECT_LE(growing.fitted.cost(), 1.01 * growing.batch_cost());
}

TEST(IncrementalFit, LandmarksPriorsAndRobustLossesEndAtTheBatchOptimum) {
  for (const LossKind kind : {LossKind::quadratic, LossKind::huber, LossKind::cauchy}) {
    IncrementalOptions options;
    options.loss = {kind, 2, 0};
    IncrementalFit fitted(options);
    RelationGraph graph;
    const auto relate = [&](const GraphRelation& r) { fitted.add_relation(r), graph.relations.push_back(r); };
    const auto add = [&](const Pose2& start, bool is_landmark) {
      graph.is_landmark.push_back(is_landmark);
      return fitted.add_pose(start, is_landmark);
    };
    Random random(8);
    std::uint32_t last = add({}, false);
    std::uint32_t landmark = last;
    // No pose is held: priors say where the first one and every fortieth stand.
    relate({kWorld, last, PosePose{{}, 1e4 * Matrix3d::Identity()}, false});
    for (int i = 1; i < 200; ++i) {
      const PosePose odometry = noisy({1, 0, 0.05}, random);
      const std::uint32_t next = add(fitted.pose(last) * odometry.T_a_b, false);
      relate({last, next, odometry, false});
      if (i % 20 == 1) landmark = add(fitted.pose(next) * Pose2{2, 1, 0}, true);
      const Vector2d seen = fitted.pose(next).inverse() * fitted.pose(landmark).translation();
      const double outlier = i % 7 == 0 ? 1.5 : 0.1;
      relate({next, landmark,
              PointPosition{seen + outlier * Vector2d(random.normal(), random.normal()), 100 * Matrix2d::Identity()},
              true});
      if (i % 40 == 0) relate({kWorld, next, noisy(fitted.pose(next), random), true});
      EXPECT_TRUE(fitted.update().is_determined);
      last = next;
    }
    for (int i = 0; i < 30; ++i) fitted.update();
    graph.poses = fitted.poses();
    FitOptions batch;
    batch.loss = options.loss;
    EXPECT_LE(fitted.cost(), 1.01 * fit(graph, {}, batch).final_cost) << "loss " << static_cast<int>(kind);
  }
}

TEST(IncrementalFit, StepsRepeatToTheBit) {
  const auto steps = walk_on_grid(7, 400);
  Growing first, second;
  for (const auto& step : steps) first.grow(step), second.grow(step);
  EXPECT_EQ(first.fitted.poses(), second.fitted.poses());
}

}  // namespace helicoid
