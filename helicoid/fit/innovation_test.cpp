#include "helicoid/fit/innovation.hpp"

#include <gtest/gtest.h>

#include "helicoid/fit/consistent_start.hpp"
#include "tests/random_graph.hpp"

namespace helicoid {

namespace {

/// The least chi^2 of these relations.
double least_chi2(const RelationGraph& graph, const std::vector<bool>& taken) {
  return 2 * FittedPart(graph, taken, graph.poses, default_gauge(graph), {}).cost();
}

/// A graph whose relations contradict one another by little, so that their sum of squares is nearly quadratic.
RelationGraph stiff_graph(std::uint64_t seed) {
  RelationGraph graph = random_graph(seed, 30, 20, 0.001);
  for (GraphRelation& r : graph.relations) {
    auto& m = std::get<PosePose>(r.measurement);
    const Pose2 exact = graph.poses[r.a].inverse() * graph.poses[r.b];
    m.T_a_b = exact * exponential(0.01 * (exact.inverse() * m.T_a_b).vector());
  }
  return graph;
}

}  // namespace

TEST(Innovation, OfATakenRelationIsWhatLeavingItOutGains) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RelationGraph graph = stiff_graph(seed);
    std::vector<bool> taken(graph.relations.size(), true);
    const FittedPart whole(graph, taken, graph.poses, default_gauge(graph), {});
    for (std::size_t i = 0; i < taken.size(); ++i) {
      if (!graph.relations[i].may_be_wrong) continue;
      taken[i] = false;
      const double gain = 2 * whole.cost() - least_chi2(graph, taken);
      taken[i] = true;
      EXPECT_NEAR(whole.innovation(graph.relations[i], true).chi2, gain, 1e-3 * gain + 1e-9) << "relation " << i;
    }
  }
}

TEST(Innovation, OfARelationThatIsNotTakenIsWhatTakingItCosts) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RelationGraph graph = stiff_graph(seed);
    std::vector<bool> taken(graph.relations.size(), true);
    const double whole = least_chi2(graph, taken);
    for (std::size_t i = 0; i < taken.size(); ++i) {
      if (!graph.relations[i].may_be_wrong) continue;
      taken[i] = false;
      const FittedPart part(graph, taken, graph.poses, default_gauge(graph), {});
      taken[i] = true;
      const double cost = whole - 2 * part.cost();
      EXPECT_NEAR(part.innovation(graph.relations[i], false).chi2, cost, 1e-3 * cost + 1e-9) << "relation " << i;
    }
  }
}

TEST(Innovation, WhatAloneHoldsAPoseContradictsNothing) {
  RelationGraph graph = random_graph(4, 10, 0);
  graph.relations.back().may_be_wrong = true;
  const std::vector<bool> all(graph.relations.size(), true);
  const FittedPart part(graph, all, graph.poses, default_gauge(graph), {});
  EXPECT_NEAR(part.innovation(graph.relations.back(), true).chi2, 0, 1e-9);
}

TEST(ChiSquareQuantile, IsThatOfTablesForThreeDegreesOfFreedom) {
  EXPECT_NEAR(chi_square_quantile(0.05), 7.814728, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.01), 11.344867, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.001), 16.266236, 1e-6);
}

}  // namespace helicoid
