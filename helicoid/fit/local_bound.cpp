#include "helicoid/fit/local_bound.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace helicoid {

namespace {

/// One radian of heading counts as much as this many metres when paths are compared: about a patch's reach.
constexpr double kLever = 3;
/// A pair whose information is weaker than this share of its strongest in some direction leaves it open.
constexpr double kOpen = 1e-12;

/// The inverse of a pair's information, exact: adding to the information, however little, would make a bound of it
/// that does not hold. An open direction makes all of it unbounded: no limit admits it.
Matrix3d pair_covariance(const Matrix3d& information) {
  const Eigen::LDLT<Matrix3d> factor(information);
  const Vector3d pivots = factor.vectorD();
  if (!(pivots.minCoeff() > kOpen * pivots.maxCoeff())) return 1e12 * Matrix3d::Identity();
  Matrix3d covariance;
  // By columns: a product with the whole identity is solved by a kernel for large matrices.
  for (Eigen::Index c = 0; c < 3; ++c) covariance.col(c) = factor.solve(Vector3d::Unit(c));
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace

Matrix3d noise_floor(double position, double heading) {
  return Vector3d(position * position, position * position, heading * heading).asDiagonal();
}

Matrix3d with_noise_floor(const UncertainPose2& ab, const Matrix3d& floor_a, const Matrix3d& floor_b) {
  // a's own error moves b by its lever; b's adds as it is, since it is the same in all directions.
  const Vector2d lever(-ab.T_a_b.y, ab.T_a_b.x);
  Matrix3d result = ab.covariance + floor_a + floor_b;
  const Vector2d by_turn = floor_a.topRightCorner<2, 1>() + 0.5 * floor_a(2, 2) * lever;
  result.topLeftCorner<2, 2>() += lever * by_turn.transpose() + by_turn * lever.transpose();
  result.topRightCorner<2, 1>() += floor_a(2, 2) * lever;
  result.bottomLeftCorner<1, 2>() += floor_a(2, 2) * lever.transpose();
  return result;
}

std::uint32_t InformationGraph::add_pose() {
  nodes_.emplace_back();
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void InformationGraph::add(std::uint32_t a, std::uint32_t b, const Pose2& T_a_b, const Matrix3d& information) {
  accumulate(a, b, information);
  // T_b_a's parameters are a function of T_a_b's: information moves by the inverse Jacobian.
  const Matrix3d back = invert_with_jacobian(T_a_b.inverse()).by_pose;
  accumulate(b, a, transport(back.transpose(), information));
}

void InformationGraph::forget(std::uint32_t a, std::uint32_t b) {
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
    for (Edge& edge : nodes_[from].edges) {
      if (edge.to == to) edge.information.setZero();
    }
  }
}

void InformationGraph::accumulate(std::uint32_t from, std::uint32_t to, const Matrix3d& information) {
  Node& node = nodes_[from];
  const auto way = std::find_if(node.ways.begin(), node.ways.end(), [to](const Way& w) { return w.to == to; });
  const auto at = static_cast<std::size_t>(way - node.ways.begin());
  if (way == node.ways.end()) {
    node.ways.push_back({to, 0});
    node.edges.push_back({.to = to});
  }
  Edge& edge = node.edges[at];
  edge.information += information;
  edge.covariance = pair_covariance(edge.information);
  node.ways[at].spread = edge.covariance(0, 0) + edge.covariance(1, 1) + kLever * kLever * edge.covariance(2, 2);
}

namespace {

/// Information about all `poses` but the first, which is held, in its frame: so that the result does not turn with the
/// plane.
Eigen::MatrixXd subgraph_information(const InformationGraph& graph, std::span<const Pose2> T_plane,
                                     std::span<const std::uint32_t> poses) {
  std::vector<std::int32_t> place(graph.size(), -1);
  for (std::size_t i = 0; i < poses.size(); ++i) place[poses[i]] = static_cast<std::int32_t>(i);
  const auto unknowns = static_cast<Eigen::Index>(3 * (poses.size() - 1));
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(unknowns, unknowns);
  const Pose2 T_reference_plane = T_plane[poses[0]].inverse();
  for (const std::uint32_t a : poses) {
    const Pose2 T_ref_a = T_reference_plane * T_plane[a];
    for (const InformationGraph::Edge& edge : graph.edges(a)) {
      const std::int32_t j = place[edge.to];
      const std::int32_t i = place[a];
      if (j < 0 || edge.to < a) continue;
      const Pose2 T_a_b = T_ref_a.inverse() * (T_reference_plane * T_plane[edge.to]);
      Matrix3d by_b = Matrix3d::Identity();
      by_b.topLeftCorner<2, 2>() = T_ref_a.rotation().transpose();
      Matrix3d by_a = -by_b;
      by_a(0, 2) = T_a_b.y;
      by_a(1, 2) = -T_a_b.x;
      const Eigen::Index row = 3 * (i - 1);
      const Eigen::Index column = 3 * (j - 1);
      if (i > 0) H.block<3, 3>(row, row) += by_a.transpose() * edge.information * by_a;
      if (j > 0) H.block<3, 3>(column, column) += by_b.transpose() * edge.information * by_b;
      if (i > 0 && j > 0) {
        const Matrix3d cross = by_a.transpose() * edge.information * by_b;
        H.block<3, 3>(row, column) += cross;
        H.block<3, 3>(column, row) += cross.transpose();
      }
    }
  }
  return H;
}

}  // namespace

std::vector<UncertainPose2> subgraph_covariance(const InformationGraph& graph, std::span<const Pose2> T_plane,
                                                std::span<const std::uint32_t> poses) {
  std::vector<UncertainPose2> result(poses.size());
  if (poses.size() < 2) return result;
  const Eigen::MatrixXd H = subgraph_information(graph, T_plane, poses);
  const Eigen::LLT<Eigen::MatrixXd> factor(H);
  const bool solved = factor.info() == Eigen::Success;
  const Eigen::MatrixXd covariance =
      solved ? Eigen::MatrixXd(factor.solve(Eigen::MatrixXd::Identity(H.rows(), H.cols()))) : Eigen::MatrixXd();
  const Pose2 T_reference_plane = T_plane[poses[0]].inverse();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * (i - 1));
    result[i].T_a_b = T_reference_plane * T_plane[poses[i]];
    result[i].covariance = solved ? Matrix3d(covariance.block<3, 3>(at, at)) : Matrix3d::Constant(HUGE_VAL);
  }
  return result;
}

}  // namespace helicoid
