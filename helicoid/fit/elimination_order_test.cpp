#include "helicoid/fit/elimination_order.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "helicoid/base/random.hpp"
#include "helicoid/fit/supernodes.hpp"

namespace helicoid {

namespace {

Adjacency grid(std::int32_t side) {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  for (std::int32_t i = 0; i < side * side; ++i) {
    if (i % side != 0) pairs.emplace_back(i - 1, i);
    if (i >= side) pairs.emplace_back(i - side, i);
  }
  return find_adjacency(side * side, pairs);
}

bool is_permutation_of_nodes(std::vector<std::int32_t> order) {
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] != static_cast<std::int32_t>(i)) return false;
  }
  return true;
}

}  // namespace

TEST(Adjacency, HoldsEveryPairOnceBothWaysAndAscending) {
  const std::vector<std::pair<std::int32_t, std::int32_t>> pairs = {{2, 0}, {0, 1}, {1, 0}, {3, 3}, {0, 2}, {0, 3}};
  const Adjacency graph = find_adjacency(4, pairs);
  EXPECT_THAT(graph.of(0), testing::ElementsAre(1, 2, 3));
  EXPECT_THAT(graph.of(1), testing::ElementsAre(0));
  EXPECT_THAT(graph.of(2), testing::ElementsAre(0));
  EXPECT_THAT(graph.of(3), testing::ElementsAre(0));
}

TEST(EliminationOrder, IsAPermutationOfTheNodes) {
  const std::vector<std::pair<std::int32_t, std::int32_t>> none;
  for (const Ordering ordering : {Ordering::natural, Ordering::minimum_degree, Ordering::nested_dissection}) {
    for (const std::int32_t nodes : {1, 2, 7}) {
      EXPECT_TRUE(is_permutation_of_nodes(find_elimination_order(find_adjacency(nodes, none), ordering)));
    }
    EXPECT_TRUE(is_permutation_of_nodes(find_elimination_order(grid(20), ordering)));
  }
}

TEST(EliminationOrder, IsTheSameEveryTime) {
  EXPECT_EQ(find_elimination_order(grid(40), Ordering::nested_dissection),
            find_elimination_order(grid(40), Ordering::nested_dissection));
}

TEST(EliminationOrder, FillsInLessThanTheNaturalOneOnAGrid) {
  const Adjacency graph = grid(40);
  const auto panels = [&](Ordering ordering) {
    return find_supernodes(graph, find_elimination_order(graph, ordering)).panels;
  };
  EXPECT_LT(2 * panels(Ordering::minimum_degree), panels(Ordering::natural));
  EXPECT_LT(2 * panels(Ordering::nested_dissection), panels(Ordering::natural));
}

TEST(EliminationOrder, AStarWithManyLeavesIsOrderedQuicklyAndFillsNothingIn) {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  for (std::int32_t i = 1; i < 20000; ++i) pairs.emplace_back(0, i);
  const Adjacency graph = find_adjacency(20000, pairs);
  const Supernodes supernodes = find_supernodes(graph, find_elimination_order(graph, Ordering::nested_dissection));
  EXPECT_LT(supernodes.panels, std::size_t{20000} * 3 * 64);
}

TEST(Supernodes, ChildrenStandBeforeTheirParentsAndTheirRowsInTheParentsFront) {
  for (const Ordering ordering : {Ordering::natural, Ordering::minimum_degree, Ordering::nested_dissection}) {
    const Adjacency graph = grid(17);
    const Supernodes s = find_supernodes(graph, find_elimination_order(graph, ordering));
    ASSERT_TRUE(is_permutation_of_nodes(s.order));
    for (std::size_t k = 0; k < s.tree.size(); ++k) {
      const Supernode& node = s.tree[k];
      EXPECT_EQ(node.parent == -1, node.below == 0);
      if (node.parent < 0) continue;
      ASSERT_GT(node.parent, static_cast<std::int32_t>(k));
      const Supernode& parent = s.tree[node.parent];
      const auto rows = s.rows_of(parent);
      for (const std::int32_t row : s.rows_of(node)) {
        const bool eliminated = row >= parent.first && row < parent.first + parent.count;
        EXPECT_TRUE(eliminated || std::binary_search(rows.begin(), rows.end(), row));
      }
    }
  }
}

}  // namespace helicoid
