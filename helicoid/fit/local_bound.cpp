#include "helicoid/fit/local_bound.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

namespace helicoid {

namespace {

/// One radian of heading counts as much as this many metres when paths are compared: about a patch's reach.
constexpr double kLever = 3;
/// A pair whose information is weaker than this share of its strongest in some direction leaves it open.
constexpr double kOpen = 1e-12;

struct Visit {
  double length;
  std::uint32_t pose;
  std::uint32_t from;
  const InformationGraph::Edge* edge;
  bool operator>(const Visit& other) const {
    return length != other.length ? length > other.length : pose > other.pose;
  }
};

/// The inverse of a pair's information, exact: adding to the information, however little, would make a bound of it
/// that does not hold. An open direction makes all of it unbounded: no limit admits it.
Matrix3d pair_covariance(const Matrix3d& information) {
  const Eigen::LDLT<Matrix3d> factor(information);
  const Vector3d pivots = factor.vectorD();
  if (!(pivots.minCoeff() > kOpen * pivots.maxCoeff())) return 1e12 * Matrix3d::Identity();
  const Matrix3d covariance = factor.solve(Matrix3d::Identity());
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace

Matrix3d noise_floor(double position, double heading) {
  return Vector3d(position * position, position * position, heading * heading).asDiagonal();
}

Matrix3d with_noise_floor(const UncertainPose2& ab, const Matrix3d& floor_a, const Matrix3d& floor_b) {
  // a's own error moves b by its lever; b's adds as it is, since it is the same in all directions.
  Matrix3d lever = Matrix3d::Identity();
  lever(0, 2) = -ab.T_a_b.y;
  lever(1, 2) = ab.T_a_b.x;
  return ab.covariance + transport(lever, floor_a) + floor_b;
}

std::uint32_t InformationGraph::add_pose() {
  edges_.emplace_back();
  return static_cast<std::uint32_t>(edges_.size() - 1);
}

void InformationGraph::add(std::uint32_t a, std::uint32_t b, const Pose2& T_a_b, const Matrix3d& information) {
  accumulate(a, b, information);
  // T_b_a's parameters are a function of T_a_b's: information moves by the inverse Jacobian.
  const Matrix3d back = invert_with_jacobian(T_a_b.inverse()).by_pose;
  accumulate(b, a, transport(back.transpose(), information));
}

void InformationGraph::accumulate(std::uint32_t from, std::uint32_t to, const Matrix3d& information) {
  auto& edges = edges_[from];
  auto at = std::find_if(edges.begin(), edges.end(), [to](const Edge& e) { return e.to == to; });
  if (at == edges.end()) at = edges.insert(edges.end(), Edge{to, Matrix3d::Zero(), 0, Matrix3d::Zero()});
  at->information += information;
  at->covariance = pair_covariance(at->information);
  at->spread = at->covariance(0, 0) + at->covariance(1, 1) + kLever * kLever * at->covariance(2, 2);
}

namespace {

/// The tree of shortest paths from the reference, all in the reference's frame.
class BoundTree {
 public:
  BoundTree(const InformationGraph& graph, std::span<const Pose2> T_plane, std::uint32_t reference,
            const BoundOptions& options)
      : graph_(graph),
        T_plane_(T_plane),
        options_(options),
        floor_(noise_floor(options.floor_position, options.floor_heading)),
        p_reference_(T_plane[reference].translation()),
        yaw_reference_(T_plane[reference].yaw),
        R_reference_plane_(T_plane[reference].rotation().transpose()),
        place_(graph.size(), kUnseen),
        shortest_(graph.size(), HUGE_VAL) {
    found_.push_back({reference, {}});
    rotations_.emplace_back(Matrix2d::Identity());
    place_[reference] = 0;
    follow_edges({0, reference, reference, nullptr});
  }

  std::vector<BoundedPose> grow() && {
    while (!heap_.empty() && found_.size() < options_.most) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const Visit visit = heap_.back();
      heap_.pop_back();
      if (place_[visit.pose] == kUnseen && reach(visit)) follow_edges(visit);
    }
    for (std::size_t i = 1; i < found_.size(); ++i) {
      found_[i].relative.covariance = with_noise_floor(found_[i].relative, floor_, floor_);
    }
    return std::move(found_);
  }

 private:
  static constexpr std::int32_t kUnseen = -1;
  static constexpr std::int32_t kTooUncertain = -2;

  /// Takes the pose into the tree, if it is known well enough.
  bool reach(const Visit& visit) {
    const auto from = static_cast<std::size_t>(place_[visit.from]);
    const Vector2d p = R_reference_plane_ * (T_plane_[visit.pose].translation() - p_reference_);
    BoundedPose bounded{visit.pose, {{p.x(), p.y(), wrap_angle(T_plane_[visit.pose].yaw - yaw_reference_)}, {}}};
    bounded.relative.covariance = covariance_beyond(found_[from], rotations_[from], p, visit.edge->covariance);
    const ConfidenceInterval interval = confidence_interval(with_noise_floor(bounded.relative, floor_, floor_));
    if (interval.position >= options_.position || interval.heading >= options_.heading) {
      place_[visit.pose] = kTooUncertain;
      return false;
    }
    place_[visit.pose] = static_cast<std::int32_t>(found_.size());
    found_.push_back(bounded);
    rotations_.push_back(bounded.relative.T_a_b.rotation());
    return true;
  }

  /// As compound() has it: the error of `from` acts by the lever from there to p, the edge's in its own frame.
  static Matrix3d covariance_beyond(const BoundedPose& from, const Matrix2d& R_reference_from, const Vector2d& p,
                                    const Matrix3d& edge) {
    Matrix3d result = from.relative.covariance;
    const Vector2d off = p - from.relative.T_a_b.translation();
    const Vector2d lever(-off.y(), off.x());
    const Vector2d by_turn = result.topRightCorner<2, 1>() + 0.5 * result(2, 2) * lever;
    result.topLeftCorner<2, 2>() += lever * by_turn.transpose() + by_turn * lever.transpose() +
                                    R_reference_from * edge.topLeftCorner<2, 2>() * R_reference_from.transpose();
    result.topRightCorner<2, 1>() += result(2, 2) * lever + R_reference_from * edge.topRightCorner<2, 1>();
    result(2, 2) += edge(2, 2);
    result(1, 0) = result(0, 1);
    result.bottomLeftCorner<1, 2>() = result.topRightCorner<2, 1>().transpose();
    return result;
  }

  void follow_edges(const Visit& visit) {
    for (const InformationGraph::Edge& edge : graph_.edges(visit.pose)) {
      const double length = visit.length + edge.spread;
      if (place_[edge.to] != kUnseen || length >= shortest_[edge.to]) continue;
      if ((T_plane_[edge.to].translation() - p_reference_).squaredNorm() > options_.radius * options_.radius) continue;
      shortest_[edge.to] = length;
      heap_.push_back({length, edge.to, visit.pose, &edge});
      std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }
  }

  const InformationGraph& graph_;
  std::span<const Pose2> T_plane_;
  const BoundOptions& options_;
  Matrix3d floor_;
  Vector2d p_reference_;
  double yaw_reference_;
  Matrix2d R_reference_plane_;
  std::vector<BoundedPose> found_;
  std::vector<Matrix2d> rotations_;  ///< by place in found_: of T_reference_pose
  std::vector<std::int32_t> place_;  ///< by pose: in found_
  std::vector<double> shortest_;     ///< by pose: of the paths to it seen so far
  std::vector<Visit> heap_;
};

}  // namespace

std::vector<BoundedPose> tree_bound(const InformationGraph& graph, std::span<const Pose2> T_plane,
                                    std::uint32_t reference, const BoundOptions& options) {
  return BoundTree(graph, T_plane, reference, options).grow();
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
