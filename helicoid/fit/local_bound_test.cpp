#include "helicoid/fit/local_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

using MatrixX = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

struct Relation {
  std::uint32_t a, b;
  Matrix3d information;  ///< of T_a_b
};

struct Graph {
  std::vector<Pose2> poses;
  std::vector<Relation> relations;

  [[nodiscard]] InformationGraph information() const {
    InformationGraph graph;
    for (std::size_t i = 0; i < poses.size(); ++i) graph.add_pose();
    for (const Relation& r : relations) graph.add(r.a, r.b, poses[r.a].inverse() * poses[r.b], r.information);
    return graph;
  }
};

/// Anisotropic: standard deviations from a millimetre to ten centimetres along any directions; a share of them is
/// nearly open in one direction, as a corridor's is.
Matrix3d random_information(Random& random, double open_share) {
  Matrix3d A;
  for (double& a : A.reshaped()) a = random.normal();
  const Matrix3d Q = Eigen::SelfAdjointEigenSolver<Matrix3d>(A * A.transpose()).eigenvectors();
  Vector3d eigenvalues;
  for (int i = 0; i < 3; ++i) eigenvalues[i] = std::pow(10, random.uniform(2, 6));
  if (random.chance(open_share)) eigenvalues[0] = std::pow(10, random.uniform(-4, 0));
  return transport(Q, eigenvalues.asDiagonal());
}

/// 3 to 40 poses; a tree, a ring, a chain with shortcuts, or a dense tangle.
Graph random_graph(std::uint64_t seed, double open_share = 0.2) {
  Random random(seed);
  Graph graph;
  const auto count = static_cast<std::uint32_t>(3 + random.below(38));
  const std::uint64_t shape = random.below(4);
  for (std::uint32_t i = 0; i < count; ++i) {
    graph.poses.push_back({random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3.14, 3.14)});
    if (i == 0) continue;
    const auto parent = shape == 0 ? static_cast<std::uint32_t>(random.below(i)) : i - 1;
    graph.relations.push_back({parent, i, random_information(random, open_share)});
  }
  if (shape == 1) graph.relations.push_back({0, count - 1, random_information(random, open_share)});
  const std::uint64_t extra = shape == 2 ? count / 3 : shape == 3 ? 2 * count : 0;
  for (std::uint64_t k = 0; k < extra; ++k) {
    const auto a = static_cast<std::uint32_t>(random.below(count));
    const auto b = static_cast<std::uint32_t>(random.below(count));
    if (a != b) graph.relations.push_back({a, b, random_information(random, open_share)});
  }
  return graph;
}

/// Covariances relative to one pose from all relations, in extended precision; written down apart from the code that
/// is tested. The graph is connected.
class ExactCovariance {
 public:
  ExactCovariance(const Graph& graph, std::uint32_t reference) {
    const auto size = static_cast<Eigen::Index>(3 * graph.poses.size());
    MatrixX H = MatrixX::Zero(size, size);
    for (const Relation& r : graph.relations) {
      const Pose2 T_ref_a = graph.poses[reference].inverse() * graph.poses[r.a];
      const Pose2 T_ref_b = graph.poses[reference].inverse() * graph.poses[r.b];
      const Inversion inverse = invert_with_jacobian(T_ref_a);
      const Composition c = compose_with_jacobians(inverse.T_b_a, T_ref_b);
      const Matrix3l J[2] = {(c.by_first * inverse.by_pose).cast<long double>(), c.by_second.cast<long double>()};
      const Eigen::Index at[2] = {3 * r.a, 3 * r.b};
      for (int k = 0; k < 2; ++k) {
        for (int l = 0; l < 2; ++l) {
          H.block<3, 3>(at[k], at[l]) += J[k].transpose() * r.information.cast<long double>() * J[l];
        }
      }
    }
    H.middleRows<3>(3 * reference).setZero();
    H.middleCols<3>(3 * reference).setZero();
    H.block<3, 3>(3 * reference, 3 * reference).setIdentity();
    factor_.compute(H);
  }

  [[nodiscard]] Matrix3d of(std::uint32_t pose) const {
    MatrixX right = MatrixX::Zero(factor_.rows(), 3);
    right.middleRows<3>(3 * pose).setIdentity();
    return factor_.solve(right).middleRows<3>(3 * pose).cast<double>();
  }

 private:
  using Matrix3l = Eigen::Matrix<long double, 3, 3>;
  Eigen::LLT<MatrixX> factor_;
};

/// How far `bound` falls short of `exact`, in the Loewner order and relative to its size; 0 if it does not.
double shortfall(const Matrix3d& bound, const Matrix3d& exact) {
  const double least = Eigen::SelfAdjointEigenSolver<Matrix3d>(bound - exact).eigenvalues().minCoeff();
  return std::max(0.0, -least / bound.norm());
}

/// A pair's information spans eight decades and moves by levers of some 10 m: its inverse keeps about seven digits.
constexpr double kRounding = 1e-7;

BoundOptions without_floor(double position, double heading) {
  BoundOptions options;
  options.position = position;
  options.heading = heading;
  options.radius = 1e3;
  options.floor_position = options.floor_heading = 0;
  return options;
}

TEST(LocalBound, IsNeverSmallerThanTheExactCovarianceOnTenThousandGraphs) {
  std::size_t compared = 0;
  for (std::uint64_t seed = 1; seed <= 10000; ++seed) {
    const Graph graph = random_graph(seed);
    const auto reference = static_cast<std::uint32_t>(seed % graph.poses.size());
    const auto bounded = tree_bound(graph.information(), graph.poses, reference, without_floor(10, 10));
    if (bounded.size() < 2) continue;
    const ExactCovariance exact(graph, reference);
    // The last are the widest; a few of each graph tell as much as all.
    for (std::size_t i = std::max<std::size_t>(1, bounded.size() - 4); i < bounded.size(); ++i) {
      const Matrix3d covariance = exact.of(bounded[i].pose);
      ASSERT_LE(shortfall(bounded[i].relative.covariance, covariance), kRounding) << "seed " << seed;
      ++compared;
    }
  }
  EXPECT_GT(compared, 20000U);
}

TEST(LocalBound, OfASubGraphIsNeverSmallerThanThatOfTheWhole) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Graph graph = random_graph(seed);
    const InformationGraph information = graph.information();
    const auto bounded = tree_bound(information, graph.poses, 0, without_floor(3, 3));
    if (bounded.size() < 2) continue;
    std::vector<std::uint32_t> poses;
    poses.reserve(bounded.size());
    for (const BoundedPose& b : bounded) poses.push_back(b.pose);
    const ExactCovariance exact(graph, 0);
    const auto sub = subgraph_covariance(information, graph.poses, poses);
    for (std::size_t i = 1; i < poses.size(); ++i) {
      // Between the two: more relations than the tree, fewer than all.
      ASSERT_LE(shortfall(sub[i].covariance, exact.of(poses[i])), kRounding) << "seed " << seed;
      ASSERT_LE(shortfall(bounded[i].relative.covariance, sub[i].covariance), kRounding) << "seed " << seed;
    }
  }
}

TEST(LocalBound, OfTheWholeGraphIsExact) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Graph graph = random_graph(seed, 0);
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < graph.poses.size(); ++i) all.push_back(i);
    const ExactCovariance exact(graph, 0);
    const auto sub = subgraph_covariance(graph.information(), graph.poses, all);
    for (std::size_t i = 1; i < all.size(); ++i) {
      const Matrix3d covariance = exact.of(all[i]);
      ASSERT_LE((sub[i].covariance - covariance).norm(), 1e-6 * covariance.norm()) << "seed " << seed;
    }
  }
}

TEST(LocalBound, DoesNotDependOnThePlane) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Graph graph = random_graph(seed);
    const auto before = tree_bound(graph.information(), graph.poses, 0, without_floor(3, 3));
    for (Pose2& pose : graph.poses) pose = Pose2{100, -40, 2} * pose;
    const auto after = tree_bound(graph.information(), graph.poses, 0, without_floor(3, 3));
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      ASSERT_EQ(before[i].pose, after[i].pose);
      ASSERT_LE((before[i].relative.covariance - after[i].relative.covariance).norm(),
                1e-7 * before[i].relative.covariance.norm());
    }
  }
}

TEST(LocalBound, KeepsToItsLimits) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Graph graph = random_graph(seed);
    const BoundOptions options = without_floor(0.5, 0.2);
    const auto bounded = tree_bound(graph.information(), graph.poses, 0, options);
    ASSERT_FALSE(bounded.empty());
    EXPECT_EQ(bounded[0].pose, 0U);
    for (const BoundedPose& b : bounded) {
      const ConfidenceInterval interval = confidence_interval(b.relative.covariance);
      EXPECT_LT(interval.position, options.position);
      EXPECT_LT(interval.heading, options.heading);
    }
  }
}

TEST(LocalBound, FollowsPosesInDoubtOnlyWhereTheyMayBeAmongTheNearest) {
  constexpr std::size_t kNearest = 5;
  std::size_t doubtful = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Graph graph = random_graph(seed);
    BoundOptions options = without_floor(0.5, 0.2);
    options.slack = 3;
    options.nearest = kNearest;
    const auto bounded = tree_bound(graph.information(), graph.poses, 0, options);
    for (std::size_t i = 1; i < bounded.size(); ++i) {
      const ConfidenceInterval interval = confidence_interval(bounded[i].relative.covariance);
      EXPECT_LT(interval.position, options.slack * options.position);
      EXPECT_LT(interval.heading, options.slack * options.heading);
      if (interval.position < options.position && interval.heading < options.heading) continue;
      ++doubtful;
      // Of those that are found before it fewer than so many lie nearer.
      const auto nearer = std::count_if(bounded.begin() + 1, bounded.begin() + static_cast<std::ptrdiff_t>(i),
                                        [&](const BoundedPose& other) {
                                          return nearness(other.relative.T_a_b) < nearness(bounded[i].relative.T_a_b);
                                        });
      EXPECT_LT(nearer, static_cast<std::ptrdiff_t>(kNearest));
    }
  }
  EXPECT_GT(doubtful, 0U);
}

TEST(LocalBound, OfPosesThatAreSoughtIsThatOfALongerSearch) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Graph graph = random_graph(seed);
    BoundOptions options = without_floor(1e3, 1e3);
    const auto all = tree_bound(graph.information(), graph.poses, 0, options);
    const std::uint32_t sought[] = {static_cast<std::uint32_t>(seed % graph.poses.size())};
    options.sought = sought;
    const auto some = tree_bound(graph.information(), graph.poses, 0, options);
    ASSERT_LE(some.size(), all.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
      EXPECT_EQ(some[i].pose, all[i].pose);
      EXPECT_EQ(some[i].relative.covariance, all[i].relative.covariance);
    }
    const auto is_sought = [&](const BoundedPose& p) { return p.pose == sought[0]; };
    EXPECT_EQ(std::any_of(some.begin(), some.end(), is_sought), std::any_of(all.begin(), all.end(), is_sought));
  }
}

TEST(LocalBound, CountsTheNoiseFloorOfEitherScanOnce) {
  Graph graph;
  graph.poses = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}};
  const Matrix3d information = 1e6 * Matrix3d::Identity();
  graph.relations = {{0, 1, information}, {1, 2, information}};
  BoundOptions with = without_floor(1, 1);
  with.floor_position = 0.01;
  with.floor_heading = 0.02;
  const auto bare = tree_bound(graph.information(), graph.poses, 0, without_floor(1, 1));
  const auto floored = tree_bound(graph.information(), graph.poses, 0, with);
  ASSERT_EQ(floored.size(), 3U);
  // The reference's heading moves what is 4 m ahead sideways by 4 m times its error.
  const Matrix3d added = floored[2].relative.covariance - bare[2].relative.covariance;
  EXPECT_NEAR(added(0, 0), 2 * 1e-4, 1e-12);
  EXPECT_NEAR(added(1, 1), 2 * 1e-4 + 16 * 4e-4, 1e-12);
  EXPECT_NEAR(added(2, 2), 2 * 4e-4, 1e-12);
}

TEST(LocalBound, WhatIsNotConnectedIsAbsentAndNotCertain) {
  Graph graph;
  graph.poses = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  graph.relations = {{0, 1, 1e4 * Matrix3d::Identity()}, {2, 3, 1e4 * Matrix3d::Identity()}};
  const auto bounded = tree_bound(graph.information(), graph.poses, 0, without_floor(1e3, 1e3));
  ASSERT_EQ(bounded.size(), 2U);
  EXPECT_EQ(bounded[1].pose, 1U);
  const std::vector<std::uint32_t> all{0, 1, 2, 3};
  const auto sub = subgraph_covariance(graph.information(), graph.poses, all);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_FALSE(sub[i].covariance.allFinite());
}

TEST(LocalBound, WhatARelationLeavesOpenIsAbsent) {
  Graph graph;
  graph.poses = {{0, 0, 0}, {1, 0, 0}};
  graph.relations = {{0, 1, Vector3d(0, 1e4, 1e4).asDiagonal()}};  // a corridor: nothing is known along it
  EXPECT_EQ(tree_bound(graph.information(), graph.poses, 0, without_floor(100, 100)).size(), 1U);
  // Another relation of the pair closes it.
  graph.relations.push_back({1, 0, Vector3d(1e4, 0, 0).asDiagonal()});
  EXPECT_EQ(tree_bound(graph.information(), graph.poses, 0, without_floor(100, 100)).size(), 2U);
}

}  // namespace
}  // namespace helicoid
