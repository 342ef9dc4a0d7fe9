#include "helicoid/fit/relative_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/random_graph.hpp"

namespace helicoid {
namespace {

/// A relation of any strength.
void relate(FormGraph& graph, Random& random, std::uint32_t a, std::uint32_t b) {
  Matrix3d A;
  for (double& x : A.reshaped()) x = random.normal();
  const Matrix3d information = 100 * (A * A.transpose() + 0.05 * Matrix3d::Identity());
  graph.relate(a, b, information, random.uniform(0.1, 1));
}

/// A connected graph of pose-pose relations with random poses, topology and information.
FormGraph random_forms(std::uint64_t seed) {
  Random random(seed);
  FormGraph graph;
  const auto count = static_cast<std::uint32_t>(2 + random.below(30));
  for (std::uint32_t i = 0; i < count; ++i) {
    graph.poses.push_back({random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-3.14, 3.14)});
    if (i > 0) relate(graph, random, static_cast<std::uint32_t>(random.below(i)), i);
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto a = static_cast<std::uint32_t>(random.below(count));
    const auto b = static_cast<std::uint32_t>(random.below(count));
    if (a != b) relate(graph, random, a, b);
  }
  return graph;
}

/// Derivatives of (x, y, yaw) of T_a_b by the plane poses' (x, y, yaw).
struct Jacobians {
  Matrix3d by_a, by_b;
};
Jacobians plane_jacobians(const Pose2& T_plane_a, const Pose2& T_plane_b) {
  const Inversion inverse = invert_with_jacobian(T_plane_a);
  const Composition c = compose_with_jacobians(inverse.T_b_a, T_plane_b);
  return {c.by_first * inverse.by_pose, c.by_second};
}

/// By the dense inverse of the information about all plane poses but the one that is held.
Matrix3d dense_covariance(const FormGraph& graph, std::uint32_t held, std::uint32_t a, std::uint32_t b) {
  const auto size = static_cast<Eigen::Index>(3 * graph.poses.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size, size);
  const auto jacobian = [&](std::uint32_t i, std::uint32_t j) {
    const Jacobians J = plane_jacobians(graph.poses[i], graph.poses[j]);
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(3, size);
    row.middleCols<3>(3 * i) = J.by_a;
    row.middleCols<3>(3 * j) = J.by_b;
    return row;
  };
  for (const GraphEdge& e : graph.edges) {
    const Eigen::MatrixXd J = jacobian(e.a, e.b);
    const Pose2 T_a_b = graph.poses[e.a].inverse() * graph.poses[e.b];
    H += e.scale * J.transpose() * expand(*e.form, T_a_b).information * J;
  }
  H.middleRows<3>(3 * held).setZero();
  H.middleCols<3>(3 * held).setZero();
  H.block<3, 3>(3 * held, 3 * held).setIdentity();
  Eigen::MatrixXd covariance = H.fullPivLu().inverse();
  covariance.block<3, 3>(3 * held, 3 * held).setZero();
  const Eigen::MatrixXd J = jacobian(a, b);
  return J * covariance * J.transpose();
}

TEST(RelativeCovariance, EqualsTheDenseInverseWhicheverPoseIsHeld) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const FormGraph graph = random_forms(seed);
    const RelativeCovariance covariance(graph.poses, graph.edges);
    ASSERT_TRUE(covariance.is_determined());
    Random random(seed);
    const auto count = static_cast<std::uint32_t>(graph.poses.size());
    for (int k = 0; k < 6; ++k) {
      const auto a = static_cast<std::uint32_t>(random.below(count));
      const auto b = static_cast<std::uint32_t>(random.below(count));
      const auto held = static_cast<std::uint32_t>(random.below(count));
      const Matrix3d expected = a == b ? Matrix3d::Zero() : dense_covariance(graph, held, a, b);
      EXPECT_LE((covariance.of(a, b).covariance - expected).norm(), 1e-8 * expected.norm());
    }
  }
}

TEST(RelativeCovariance, DoesNotTurnWithThePlane) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    FormGraph graph = random_forms(seed);
    const RelativeCovariance before(graph.poses, graph.edges);
    for (Pose2& pose : graph.poses) pose = Pose2{30, -20, 2.5} * pose;
    const RelativeCovariance after(graph.poses, graph.edges);
    const auto last = static_cast<std::uint32_t>(graph.poses.size() - 1);
    EXPECT_TRUE(after.of(0, last).covariance.isApprox(before.of(0, last).covariance, 1e-8));
    EXPECT_TRUE(after.of(last, 0).covariance.isApprox(before.of(last, 0).covariance, 1e-8));
  }
}

TEST(RelativeCovariance, OfBRelativeToAIsTheInversionOfAsRelativeToB) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const FormGraph graph = random_forms(seed);
    const RelativeCovariance covariance(graph.poses, graph.edges);
    const auto last = static_cast<std::uint32_t>(graph.poses.size() - 1);
    EXPECT_TRUE(invert(covariance.of(0, last)).covariance.isApprox(covariance.of(last, 0).covariance, 1e-8));
  }
}

TEST(RelativeCovariance, OfASingleRelationIsItsInverse) {
  const std::vector<Pose2> poses{{1, 2, 0.5}, {2, 4, -1}};
  const Matrix3d information = Vector3d(100, 400, 2500).asDiagonal();
  const PairForm form = pose_pose_form(poses[0].inverse() * poses[1], information);
  const std::vector<GraphEdge> edges{{0, 1, &form, 1}};
  const RelativeCovariance covariance(poses, edges);
  EXPECT_TRUE(covariance.of(0, 1).covariance.isApprox(information.inverse(), 1e-10));
  EXPECT_EQ(covariance.of(1, 1).covariance, Matrix3d::Zero());
}

TEST(RelativeCovariance, IsNotDeterminedWhereAPoseHangsInTheAir) {
  const std::vector<Pose2> poses{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const PairForm form = pose_pose_form({1, 0, 0}, Matrix3d::Identity());
  const std::vector<GraphEdge> edges{{0, 1, &form, 1}};
  EXPECT_FALSE(RelativeCovariance(poses, edges).is_determined());
}

}  // namespace
}  // namespace helicoid
