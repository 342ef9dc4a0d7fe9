#include "helicoid/fit/block_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "tests/random_graph.hpp"

namespace helicoid {

namespace {

using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// A chain, and ties anywhere.
Pairs random_pairs(std::uint64_t seed, std::int32_t nodes, std::int32_t ties) {
  Random random(seed);
  Pairs pairs;
  const auto any = [&] { return static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(nodes))); };
  for (std::int32_t i = 1; i < nodes; ++i) pairs.emplace_back(i - 1, i);
  for (std::int32_t k = 0; k < ties; ++k) pairs.emplace_back(any(), any());
  return pairs;
}

/// A random positive definite matrix of blocks over a graph, its supernodes and itself as a dense matrix.
struct Sample {
  Sample(std::uint64_t seed, std::int32_t nodes, std::int32_t ties, Ordering ordering)
      : Sample(seed, nodes, random_pairs(seed, nodes, ties), ordering) {}
  Sample(std::uint64_t seed, std::int32_t nodes, const Pairs& pairs, Ordering ordering) {
    Random random(seed);
    graph = find_adjacency(nodes, pairs);
    supernodes = find_supernodes(graph, find_elimination_order(graph, ordering));
    H = make_block_matrix(graph, supernodes);
    dense = Eigen::MatrixXd::Zero(3 * nodes, 3 * nodes);
    const auto add = [&](std::int32_t i, std::int32_t j, double* block) {
      const Eigen::Map<Matrix3d> B(block);
      dense.block<3, 3>(3 * i, 3 * j) = B;
      dense.block<3, 3>(3 * j, 3 * i) = B.transpose();
    };
    for (std::int32_t k = 0; k < nodes; ++k) {
      double* diagonal = H.diagonal.data() + 9 * k;
      Eigen::Map<Matrix3d> D(diagonal);
      D = random_information(random) / 100 +
          4.0 * static_cast<double>(1 + graph.of(supernodes.order[k]).size()) * Matrix3d::Identity();
      add(k, k, diagonal);
      for (std::size_t e = H.first[k]; e < H.first[k + 1]; ++e) {
        for (int i = 0; i < 9; ++i) H.below[9 * e + i] = random.uniform(-1, 1);
        add(H.row[e], k, H.below.data() + 9 * e);
      }
    }
  }
  Adjacency graph;
  Supernodes supernodes;
  BlockMatrix H;
  Eigen::MatrixXd dense;
};

constexpr Ordering kOrderings[] = {Ordering::natural, Ordering::minimum_degree, Ordering::nested_dissection};

/// The best kernels of this machine and the portable ones.
std::vector<const FrontKernels*> kernels() {
  return {&front_kernels(), &portable_front_kernels()};
}

void expect_diagonal(const std::vector<double>& blocks, const Eigen::MatrixXd& inverse) {
  for (Eigen::Index i = 0; 9 * i < static_cast<Eigen::Index>(blocks.size()); ++i) {
    const Eigen::Map<const Matrix3d> block(blocks.data() + 9 * i);
    EXPECT_LT((block - inverse.block<3, 3>(3 * i, 3 * i)).lpNorm<Eigen::Infinity>(), 1e-12);
  }
}

void expect_as_dense(const Sample& s) {
  Random random(7);
  Eigen::VectorXd right(s.dense.rows());
  for (double& r : right) r = random.normal();
  const Eigen::VectorXd expected = s.dense.llt().solve(right);
  const Eigen::MatrixXd inverse = s.dense.inverse();
  for (const FrontKernels* k : kernels()) {
    BlockCholesky cholesky(s.supernodes, *k);
    ASSERT_TRUE(cholesky.factorise(s.H));
    Eigen::VectorXd x = right;
    cholesky.solve({x.data(), static_cast<std::size_t>(x.size())});
    EXPECT_LT((x - expected).lpNorm<Eigen::Infinity>(), 1e-11) << k->processor_class;
    expect_diagonal(cholesky.inverse_diagonal(), inverse);
  }
}

}  // namespace

TEST(BlockCholesky, SolvesAsADenseSolverDoesWhateverTheOrder) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    for (const Ordering ordering : kOrderings) {
      const Sample s(seed, static_cast<std::int32_t>(1 + 13 * seed), static_cast<std::int32_t>(7 * seed), ordering);
      Random random(seed);
      Eigen::VectorXd right(s.dense.rows());
      for (double& r : right) r = random.normal();
      const Eigen::VectorXd expected = s.dense.llt().solve(right);
      for (const FrontKernels* k : kernels()) {
        BlockCholesky cholesky(s.supernodes, *k);
        ASSERT_TRUE(cholesky.factorise(s.H));
        Eigen::VectorXd x = right;
        cholesky.solve({x.data(), static_cast<std::size_t>(x.size())});
        EXPECT_LT((x - expected).lpNorm<Eigen::Infinity>(), 1e-11) << k->processor_class << " seed " << seed;
        const auto size = static_cast<std::size_t>(x.size());
        EXPECT_LT(relative_residual(s.H, {x.data(), size}, {right.data(), size}), 1e-12);
        // The residual is the dense one, of other vectors, too.
        EXPECT_NEAR(relative_residual(s.H, {right.data(), size}, {right.data(), size}),
                    (s.dense * right - right).norm() / right.norm(), 1e-10);
      }
    }
  }
}

TEST(BlockCholesky, InvertsTheDiagonalAsADenseInverseDoes) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    for (const Ordering ordering : kOrderings) {
      const Sample s(seed, static_cast<std::int32_t>(20 * seed), static_cast<std::int32_t>(15 * seed), ordering);
      const Eigen::MatrixXd expected = s.dense.inverse();
      for (const FrontKernels* k : kernels()) {
        BlockCholesky cholesky(s.supernodes, *k);
        ASSERT_TRUE(cholesky.factorise(s.H));
        expect_diagonal(cholesky.inverse_diagonal(), expected);
      }
    }
  }
}

TEST(BlockCholesky, FactorisesFrontsOfManyBands) {
  // A graph that is nearly complete has one large front: bands, packing and remainders all come into play.
  expect_as_dense(Sample(7, 190, 9000, Ordering::minimum_degree));
  // Cliques that share a set of nodes which is as large: fronts with updates of many bands, added to one another.
  for (const std::int32_t size : {31, 32, 33, 65, 70}) {
    Pairs pairs;
    for (const std::int32_t first : {0, size, 2 * size}) {
      for (std::int32_t i = first; i < first + size; ++i) {
        for (std::int32_t j = first; j < i; ++j) pairs.emplace_back(i, j);
        for (std::int32_t j = 3 * size; j < 4 * size; ++j) pairs.emplace_back(i, j);
      }
    }
    const Sample s(7, 4 * size, pairs, Ordering::natural);
    ASSERT_GT(s.supernodes.tree.size(), 2U);
    expect_as_dense(s);
  }
}

TEST(FrontShape, StoresLowerHalvesWithoutGapsAndLittleAboveTheDiagonal) {
  for (const int height : {8, 96, 104, 200, 1000}) {
    for (int columns = 1; columns <= height; ++columns) {
      std::ptrdiff_t end = 0;
      for (int c = 0; c < columns; ++c) {
        // A column is stored from the first row of its band on, after the column before it.
        EXPECT_EQ(column_of_half(height, c) + c / kBand * kBand, end);
        end = column_of_half(height, c) + height;
      }
      EXPECT_EQ(half_size(height, columns), static_cast<std::size_t>(end));
      const std::ptrdiff_t half = static_cast<std::ptrdiff_t>(height) * columns - columns * (columns - 1) / 2;
      EXPECT_LE(end, half + columns * kBand / 2);
    }
  }
}

TEST(BlockCholesky, DampingScalesTheDiagonal) {
  const Sample s(3, 40, 40, Ordering::minimum_degree);
  Eigen::MatrixXd damped = s.dense;
  damped.diagonal() *= 1.25;
  BlockCholesky cholesky(s.supernodes);
  ASSERT_TRUE(cholesky.factorise(s.H, 0.25));
  Eigen::VectorXd x = Eigen::VectorXd::Ones(s.dense.rows());
  const Eigen::VectorXd expected = damped.llt().solve(x);
  cholesky.solve({x.data(), static_cast<std::size_t>(x.size())});
  EXPECT_LT((x - expected).lpNorm<Eigen::Infinity>(), 1e-13);
}

TEST(BlockCholesky, RefusesAnIndefiniteMatrixAndFactorisesTheNext) {
  Sample s(5, 60, 60, Ordering::minimum_degree);
  BlockCholesky cholesky(s.supernodes);
  const double kept = s.H.diagonal[9 * 31];
  s.H.diagonal[9 * 31] = -1;
  EXPECT_FALSE(cholesky.factorise(s.H));
  s.H.diagonal[9 * 31] = kept;
  EXPECT_TRUE(cholesky.factorise(s.H));
}

TEST(BlockCholesky, TwiceTheSameIsTheSameToTheBit) {
  const Sample s(11, 120, 100, Ordering::nested_dissection);
  std::vector<double> results[2];
  for (auto& x : results) {
    BlockCholesky cholesky(s.supernodes);
    ASSERT_TRUE(cholesky.factorise(s.H));
    x.assign(360, 1.0);
    cholesky.solve(x);
  }
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace helicoid
