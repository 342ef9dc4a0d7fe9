#include "helicoid/fit/local_bound.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "helicoid/fit/pose_marks.hpp"

namespace helicoid {

namespace {

/// One radian of heading counts as much as this many metres when paths are compared: about a patch's reach.
constexpr double kLever = 3;
/// A pair whose information is weaker than this share of its strongest in some direction leaves it open.
constexpr double kOpen = 1e-12;

struct Visit {
  double length;
  std::uint32_t pose;
  std::uint32_t from;  ///< its place among those found
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
  Matrix3d lever = Matrix3d::Identity();
  lever(0, 2) = -ab.T_a_b.y;
  lever(1, 2) = ab.T_a_b.x;
  return ab.covariance + transport(lever, floor_a) + floor_b;
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

/// The nearest of the poses found so far: how near a pose must lie to be one of them.
class Nearest {
 public:
  explicit Nearest(std::size_t most) : most_(most) {}
  [[nodiscard]] bool has_room_for(double distance) const { return heap_.size() < most_ || distance <= heap_.front(); }
  void add(double distance) {
    if (!has_room_for(distance) || most_ == 0) return;
    if (heap_.size() == most_) {
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.pop_back();
    }
    heap_.push_back(distance);
    std::push_heap(heap_.begin(), heap_.end());
  }

 private:
  std::size_t most_;
  std::vector<double> heap_;  ///< the farthest first
};

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
        seen_at_(graph.size()),
        nearest_(options.nearest) {
    found_.push_back({reference, {}});
    branches_.push_back({Matrix3d::Zero(), Matrix2d::Identity()});
    see(reference, {0, 0});
    follow_edges({0, reference, 0, nullptr});
  }

  std::vector<BoundedPose> grow() && {
    while (!heap_.empty() && found_.size() < options_.most) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const Visit visit = heap_.back();
      heap_.pop_back();
      if (seen(visit.pose).place == kNotFound && reach(visit)) follow_edges(visit);
    }
    return std::move(found_);
  }

 private:
  static constexpr std::int32_t kNotFound = -1;
  static constexpr std::int32_t kTooUncertain = -2;
  /// A pose that some edge led to.
  struct Seen {
    double shortest;     ///< of the paths to it so far
    std::int32_t place;  ///< in found_
  };
  /// What is needed of a pose to go on from it.
  struct Branch {
    Matrix3d covariance;  ///< without the floors
    Matrix2d rotation;    ///< of T_reference_pose
  };

  Seen& seen(std::uint32_t pose) { return seen_[static_cast<std::size_t>(seen_at_[pose])]; }
  void see(std::uint32_t pose, const Seen& first) {
    seen_at_.set(pose, static_cast<std::int32_t>(seen_.size()));
    seen_.push_back(first);
  }

  /// Takes the pose into the tree, if it is known well enough.
  bool reach(const Visit& visit) {
    const Vector2d p = R_reference_plane_ * (T_plane_[visit.pose].translation() - p_reference_);
    BoundedPose bounded{visit.pose, {{p.x(), p.y(), wrap_angle(T_plane_[visit.pose].yaw - yaw_reference_)}, {}}};
    UncertainPose2 bare{bounded.relative.T_a_b, covariance_beyond(visit.from, p, visit.edge->covariance)};
    bounded.relative.covariance = with_noise_floor(bare, floor_, floor_);
    if (!is_wanted(bounded.relative)) {
      seen(visit.pose).place = kTooUncertain;
      return false;
    }
    seen(visit.pose).place = static_cast<std::int32_t>(found_.size());
    found_.push_back(bounded);
    branches_.push_back({bare.covariance, bounded.relative.T_a_b.rotation()});
    return true;
  }

  bool is_wanted(const UncertainPose2& relative) {
    const ConfidenceInterval interval = confidence_interval(relative.covariance);
    const auto is_within = [&](double times) {
      return interval.position < times * options_.position && interval.heading < times * options_.heading;
    };
    if (options_.nearest == 0 || !is_within(options_.slack)) return is_within(1);
    const double distance = nearness(relative.T_a_b);
    if (!is_within(1) && !nearest_.has_room_for(distance)) return false;
    nearest_.add(distance);
    return true;
  }

  /// As compound() has it: the error of `from` acts by the lever from there to p, the edge's in its own frame.
  [[nodiscard]] Matrix3d covariance_beyond(std::size_t from, const Vector2d& p, const Matrix3d& edge) const {
    const Matrix2d& R_reference_from = branches_[from].rotation;
    Matrix3d result = branches_[from].covariance;
    const Vector2d off = p - found_[from].relative.T_a_b.translation();
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
    const auto from = static_cast<std::uint32_t>(seen(visit.pose).place);
    const std::span<const InformationGraph::Way> ways = graph_.ways(visit.pose);
    const std::span<const InformationGraph::Edge> edges = graph_.edges(visit.pose);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const std::uint32_t to = ways[i].to;
      const double length = visit.length + ways[i].spread;
      const bool is_seen = seen_at_[to] != PoseMarks::kNone;
      if (is_seen && (seen(to).place != kNotFound || length >= seen(to).shortest)) continue;
      if ((T_plane_[to].translation() - p_reference_).squaredNorm() > options_.radius * options_.radius) continue;
      if (is_seen) {
        seen(to).shortest = length;
      } else {
        see(to, {length, kNotFound});
      }
      heap_.push_back({length, to, from, &edges[i]});
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
  std::vector<Branch> branches_;  ///< by place in found_
  PoseMarks seen_at_;             ///< by pose: where in seen_
  std::vector<Seen> seen_;
  std::vector<Visit> heap_;
  Nearest nearest_;
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
