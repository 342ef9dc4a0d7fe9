#include "helicoid/fit/fit_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "helicoid/fit/fit_from_start.hpp"
#include "helicoid/fit/initial_guess.hpp"
#include "tests/random_graph.hpp"

namespace helicoid {

TEST(FitGraph, RelationsThatAgreeAreMetExactly) {
  RelationGraph graph = random_graph(1, 40, 30, 0.2);
  const std::vector<Pose2> truth = odometry_start(graph);
  for (GraphRelation& r : graph.relations) {
    std::get<PosePose>(r.measurement).T_a_b = truth[r.a].inverse() * truth[r.b];
  }
  const FitResult fitted = fit(graph);
  EXPECT_EQ(fitted.status, FitStatus::converged);
  EXPECT_LT(fitted.final_cost, 1e-12);
  EXPECT_LT(largest_difference(fitted.poses, truth), 1e-7);
}

TEST(FitGraph, ThreeMethodsReachOneOptimum) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const RelationGraph graph = random_graph(seed, 25, 40, 0.05);
    FitOptions options;
    const FitResult best = fit(graph, options);
    ASSERT_EQ(best.status, FitStatus::converged);
    for (const FitMethod method : {FitMethod::fletcher_reeves, FitMethod::gradient_descent}) {
      options.method = method;
      const FitResult other = fit(graph, options);
      EXPECT_EQ(other.status, FitStatus::converged);
      EXPECT_NEAR(other.final_cost, best.final_cost, 1e-6 * best.final_cost);
      EXPECT_LT(largest_difference(other.poses, best.poses), 1e-3);
    }
  }
}

TEST(FitGraph, TheOptimumDoesNotDependOnHowNodesAreNumbered) {
  const RelationGraph graph = random_graph(5, 60, 80);
  const FitResult straight = fit(graph);
  const auto count = static_cast<std::uint32_t>(graph.poses.size());
  RelationGraph turned = graph;
  for (std::uint32_t i = 0; i < count; ++i) turned.poses[count - 1 - i] = graph.poses[i];
  for (GraphRelation& r : turned.relations) {
    r.a = count - 1 - r.a;
    r.b = count - 1 - r.b;
  }
  const std::uint32_t gauge[] = {count - 1};
  FitResult back = fit(turned, gauge);
  std::reverse(back.poses.begin(), back.poses.end());
  EXPECT_NEAR(back.final_cost, straight.final_cost, 1e-9 * straight.final_cost);
  EXPECT_LT(largest_difference(back.poses, straight.poses), 1e-6);
}

TEST(FitGraph, WhichPoseIsHeldMovesTheWholeAndChangesNothingElse) {
  const RelationGraph graph = random_graph(6, 50, 60);
  FitOptions options;
  options.relative_tolerance = 1e-12;
  options.step_tolerance = 1e-9;
  const std::uint32_t first[] = {0};
  const std::uint32_t other[] = {33};
  const FitResult a = fit(graph, first, options);
  const FitResult b = fit(graph, other, options);
  EXPECT_NEAR(a.final_cost, b.final_cost, 1e-10 * a.final_cost);
  const Pose2 T_a_b = a.poses[0] * b.poses[0].inverse();
  std::vector<Pose2> moved;
  for (const Pose2& T : b.poses) moved.push_back(T_a_b * T);
  EXPECT_LT(largest_difference(a.poses, moved), 1e-7);
}

TEST(FitGraph, AGoodOptimumIsReachedFromAFarStartByTheChordalOne) {
  RelationGraph graph = random_graph(7, 200, 300, 0);
  const double best = fit(graph).final_cost;
  Random random(7);
  for (Pose2& T : graph.poses) T = random_pose(random, 50);
  const StartedFit started = fit_from(graph, FitStart::automatic);
  EXPECT_EQ(started.start, FitStart::chordal);
  EXPECT_TRUE(started.is_plausible);
  EXPECT_NEAR(started.result.final_cost, best, 1e-6 * best);
}

TEST(FitGraph, AnOptimumThatNoiseCannotExplainIsCalledSo) {
  RelationGraph graph = random_graph(8, 60, 60);
  for (GraphRelation& r : graph.relations) {
    if (r.may_be_wrong) std::get<PosePose>(r.measurement).T_a_b.x += 5;
  }
  EXPECT_FALSE(fit_from(graph, FitStart::automatic).is_plausible);
}

TEST(FitGraph, EachComponentHasItsOwnGauge) {
  RelationGraph graph = random_graph(9, 20, 10);
  const RelationGraph second = random_graph(10, 15, 10);
  for (GraphRelation r : second.relations) {
    r.a += 20;
    r.b += 20;
    graph.relations.push_back(r);
  }
  graph.poses.insert(graph.poses.end(), second.poses.begin(), second.poses.end());
  EXPECT_EQ(default_gauge(graph), (std::vector<std::uint32_t>{0, 20}));
  const FitResult together = fit(graph);
  EXPECT_EQ(together.status, FitStatus::converged);
  EXPECT_NEAR(together.final_cost, fit(random_graph(9, 20, 10)).final_cost + fit(second).final_cost, 1e-6);
}

TEST(FitGraph, APriorTiesToTheWorldAndNeedsNoGauge) {
  RelationGraph graph = random_graph(11, 10, 5);
  graph.relations.push_back({kWorld, 4, PosePose{{7, -2, 1}, 1e4 * Matrix3d::Identity()}, false});
  EXPECT_TRUE(default_gauge(graph).empty());
  const FitResult fitted = fit(graph);
  EXPECT_EQ(fitted.status, FitStatus::converged);
  EXPECT_NEAR(fitted.poses[4].x, 7, 1e-6);
  EXPECT_NEAR(fitted.poses[4].y, -2, 1e-6);
  EXPECT_NEAR(fitted.poses[4].yaw, 1, 1e-6);
}

TEST(FitGraph, RelationsThatLeaveAPoseOpenAreNotCalledAFit) {
  RelationGraph graph;
  graph.poses = {{0, 0, 0}, {1, 0, 0}};
  graph.relations = {{0, 1, RelativeRange{{0, 0}, {0, 0}, 2, 0.1}, false}};
  const FitResult fitted = fit(graph);
  EXPECT_EQ(fitted.status, FitStatus::not_positive_definite);
  // The range is met; where on the circle, and which way, nothing says: damping must have chosen.
  EXPECT_NEAR(fitted.poses[1].distance(), 2, 1e-3);
}

TEST(FitGraph, NothingToFitIsSaid) {
  EXPECT_EQ(fit(RelationGraph{}).status, FitStatus::nothing_to_fit);
  EXPECT_EQ(fit_graph(std::vector<Pose2>(1), {}, 0).status, FitStatus::nothing_to_fit);
}

TEST(FitGraph, TwiceTheSameIsTheSameToTheBit) {
  const RelationGraph graph = random_graph(12, 300, 400);
  const FitResult a = fit(graph);
  const FitResult b = fit(graph);
  EXPECT_EQ(a.poses, b.poses);
  EXPECT_EQ(a.final_cost, b.final_cost);
}

}  // namespace helicoid
