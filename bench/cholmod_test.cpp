#include <gtest/gtest.h>

#include "bench/cholmod_solution.hpp"
#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/fit/initial_guess.hpp"
#include "helicoid/fit/linear_system.hpp"
#include "helicoid/io/graph_reader.hpp"
#include "tests/random_graph.hpp"

namespace helicoid {

namespace {

using Exact = std::vector<long double>;

/// right - H x.
std::vector<double> residual(const BlockMatrix& H, std::span<const double> right, const Exact& x) {
  Exact left(right.begin(), right.end());
  const auto add = [&](std::size_t row, std::size_t column, double value) { left[row] -= x[column] * value; };
  for (std::size_t k = 0; k < static_cast<std::size_t>(H.nodes()); ++k) {
    for (std::size_t i = 0; i < 9; ++i) add(3 * k + i % 3, 3 * k + i / 3, H.diagonal[9 * k + i]);
    for (std::size_t e = H.first[k]; e < H.first[k + 1]; ++e) {
      const auto row = 3 * static_cast<std::size_t>(H.row[e]);
      for (std::size_t i = 0; i < 9; ++i) {
        add(row + i % 3, 3 * k + i / 3, H.below[9 * e + i]);
        add(3 * k + i / 3, row + i % 3, H.below[9 * e + i]);
      }
    }
  }
  return {left.begin(), left.end()};
}

/// The solution of the system to the last digit, by iterative refinement: it does not depend on who refines.
Exact solve_exactly(const LinearSystem& system, std::span<const double> right) {
  Exact x(right.size(), 0);
  std::vector<double> correction(right.begin(), right.end());
  for (int i = 0; i < 8; ++i) {
    system.solve(correction);
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += correction[k];
    correction = residual(system.information(), right, x);
  }
  return x;
}

/// The largest difference from the exact solution, relative to its largest entry.
double error_of(std::span<const double> x, const Exact& exact, std::size_t begin, std::size_t size) {
  double most = 0;
  double largest = 0;
  for (std::size_t i = begin; i < begin + size; ++i) {
    most = std::max(most, static_cast<double>(std::abs(x[i - begin] - exact[i])));
    largest = std::max(largest, static_cast<double>(std::abs(exact[i])));
  }
  return most / largest;
}

/// Exact to 1e-8; where the graph is conditioned too badly for that, to what CHOLMOD reaches. Rounding falls by chance:
/// of two such errors one may be twice the other.
double allowed(double error_of_cholmod) {
  return std::max(1e-8, 2 * error_of_cholmod);
}

/// Steps and covariances of a graph of so many poses that no dense inverse could judge.
void expect_no_worse_than_cholmod(RelationGraph graph) {
  graph.poses = fit(graph).poses;
  LinearSystem system(graph, default_gauge(graph));
  Random random(1);
  for (Pose2& T : graph.poses) T = T * Pose2{0.01 * random.normal(), 0.01 * random.normal(), 0.001 * random.normal()};
  system.linearise(graph.poses);
  ASSERT_TRUE(system.factorise());
  constexpr std::size_t kColumns = 9;
  std::vector<std::vector<double>> rights(1 + kColumns, std::vector<double>(system.gradient().size(), 0.0));
  rights[0].assign(system.gradient().begin(), system.gradient().end());
  std::size_t places[kColumns];
  for (std::size_t c = 0; c < kColumns; ++c) {
    places[c] = static_cast<std::size_t>(random.below(graph.poses.size()));
    rights[1 + c][3 * places[c] + c % 3] = 1;
  }
  const CholmodSolution judged = solve_by_cholmod(system.information(), rights);
  std::vector<double> step = rights[0];
  system.solve(step);
  const Exact exact_step = solve_exactly(system, rights[0]);
  EXPECT_LT(error_of(step, exact_step, 0, step.size()),
            allowed(error_of(judged.columns[0], exact_step, 0, step.size())));
  const std::vector<double> inverse = system.inverse_diagonal();
  for (std::size_t c = 0; c < kColumns; ++c) {
    const Exact exact = solve_exactly(system, rights[1 + c]);
    const std::size_t at = 3 * places[c];
    EXPECT_LT(error_of({inverse.data() + 3 * at + 3 * (c % 3), 3}, exact, at, 3),
              allowed(error_of({judged.columns[1 + c].data() + at, 3}, exact, at, 3)))
        << "at place " << places[c];
  }
}

}  // namespace

TEST(Cholmod, IsNoCloserToTheExactSolutionOnRandomGraphs) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) expect_no_worse_than_cholmod(random_graph(seed, 3000, 1500));
}

TEST(Cholmod, IsNoCloserToTheExactSolutionOnRecordedGraphs) {
  const std::string folder = std::string(HELICOID_SOURCE_DIR) + "/../shared/data/posegraphs/";
  for (const char* name : {"intel", "manhattan", "city10000"}) {
    Result<GraphFile> file = read_graph(folder + name + ".g2o.gz");
    if (!file) GTEST_SKIP() << "the recorded graph " << name << " is not there: CHOLMOD did NOT judge it";
    file->graph.poses = odometry_start(file->graph, file->is_placed);
    expect_no_worse_than_cholmod(std::move(file->graph));
  }
}

TEST(Cholmod, SolvesInEveryMode) {
  const RelationGraph graph = random_graph(1, 300, 100);
  LinearSystem system(graph, default_gauge(graph));
  system.linearise(graph.poses);
  const std::vector<double> rights[] = {std::vector<double>(system.gradient().size(), 1.0)};
  for (const CholmodMode mode : {CholmodMode::automatic, CholmodMode::simplicial, CholmodMode::supernodal}) {
    const CholmodSolution solution = solve_by_cholmod(system.information(), rights, mode);
    EXPECT_LT(relative_residual(system.information(), solution.columns[0], rights[0]), 1e-9);
  }
}

}  // namespace helicoid
