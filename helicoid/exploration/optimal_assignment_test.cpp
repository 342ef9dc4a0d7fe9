#include "helicoid/exploration/optimal_assignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// How many rows got a column, and at which sum of costs.
struct Total {
  int assigned = 0;
  double cost = 0;
  [[nodiscard]] bool is_better_than(const Total& other) const {
    return assigned != other.assigned ? assigned > other.assigned : cost < other.cost;
  }
};

Total total_of(const Eigen::MatrixXd& cost, const std::vector<std::optional<std::size_t>>& column_of) {
  Total total;
  for (std::size_t row = 0; row < column_of.size(); ++row) {
    if (!column_of[row]) continue;
    ++total.assigned;
    total.cost += cost(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(*column_of[row]));
  }
  return total;
}

/// Every way to give columns to rows, tried one by one.
void try_all(const Eigen::MatrixXd& cost, std::vector<std::optional<std::size_t>>& chosen, std::size_t row,
             Total& best) {
  if (row == chosen.size()) {
    const Total total = total_of(cost, chosen);
    if (total.is_better_than(best)) best = total;
    return;
  }
  chosen[row].reset();
  try_all(cost, chosen, row + 1, best);
  for (std::size_t column = 0; column < static_cast<std::size_t>(cost.cols()); ++column) {
    if (std::find(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(row), column) !=
        chosen.begin() + static_cast<std::ptrdiff_t>(row)) {
      continue;
    }
    if (!std::isfinite(cost(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)))) continue;
    chosen[row] = column;
    try_all(cost, chosen, row + 1, best);
  }
  chosen[row].reset();
}

TEST(OptimalAssignment, EqualsTheBestOfAllChoices) {
  Random random(7);
  for (int round = 0; round < 300; ++round) {
    const auto rows = static_cast<Eigen::Index>(1 + random.below(4));
    const auto columns = static_cast<Eigen::Index>(1 + random.below(5));
    Eigen::MatrixXd cost(rows, columns);
    for (double& c : cost.reshaped()) c = random.chance(0.2) ? kInfinity : random.uniform(-20, 60);
    std::vector<std::optional<std::size_t>> chosen(static_cast<std::size_t>(rows));
    Total best;
    best.cost = kInfinity;
    best.assigned = -1;
    try_all(cost, chosen, 0, best);
    const Total found = total_of(cost, optimal_assignment(cost));
    EXPECT_EQ(found.assigned, best.assigned) << cost;
    EXPECT_NEAR(found.cost, best.cost, 1e-9) << cost;
  }
}

TEST(OptimalAssignment, GivesEachColumnToOneRowAtMost) {
  Random random(8);
  Eigen::MatrixXd cost(8, 40);
  for (double& c : cost.reshaped()) c = random.uniform(0, 1);
  std::set<std::size_t> columns;
  for (const auto& column : optimal_assignment(cost)) columns.insert(*column);
  EXPECT_EQ(columns.size(), 8U);
}

TEST(OptimalAssignment, OfNothingIsNothing) {
  EXPECT_TRUE(optimal_assignment(Eigen::MatrixXd(0, 3)).empty());
  const auto idle = optimal_assignment(Eigen::MatrixXd(2, 0));
  EXPECT_EQ(idle.size(), 2U);
  EXPECT_FALSE(idle[0] || idle[1]);
}

TEST(OptimalAssignment, NeverChoosesWhatIsForbidden) {
  const Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(2, 2, kInfinity);
  for (const auto& column : optimal_assignment(cost)) EXPECT_FALSE(column.has_value());
}

}  // namespace
}  // namespace helicoid
