#include "helicoid/fit/linear_system.hpp"

#include <algorithm>

#include "helicoid/fit/tie_blocks.hpp"

namespace helicoid {

namespace {

/// From so many poses on memory counts for more than a few per cent of time.
constexpr std::size_t kManyPoses = 100000;

Adjacency adjacency_of(const RelationGraph& graph) {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  pairs.reserve(graph.relations.size());
  for (const GraphRelation& r : graph.relations) {
    if (r.a != kWorld) pairs.emplace_back(static_cast<std::int32_t>(r.a), static_cast<std::int32_t>(r.b));
  }
  return find_adjacency(static_cast<std::int32_t>(graph.poses.size()), pairs);
}

}  // namespace

LinearSystem::LinearSystem(const RelationGraph& graph, std::span<const std::uint32_t> fixed, Ordering ordering)
    : LinearSystem(graph, fixed, adjacency_of(graph), ordering) {}

LinearSystem::LinearSystem(const RelationGraph& graph, std::span<const std::uint32_t> fixed, const Adjacency& adjacency,
                           Ordering ordering)
    : graph_(&graph),
      supernodes_(find_supernodes(adjacency, find_elimination_order(adjacency, ordering))),
      H_(make_block_matrix(adjacency, supernodes_)),
      gradient_(kBlock * graph.poses.size()),
      cholesky_(supernodes_) {
  if (!graph.is_landmark.empty()) {
    for (const std::int32_t node : supernodes_.order) has_no_heading_.push_back(graph.is_landmark[node]);
  }
  hold(fixed);
  tie_up();
  // The symbolic phase leaves small pieces behind that nothing large fits into.
  if (graph.poses.size() > kManyPoses) release_free_memory();
}

void LinearSystem::hold(std::span<const std::uint32_t> fixed) {
  is_fixed_.assign(graph_->poses.size(), false);
  for (const std::uint32_t node : fixed) is_fixed_[static_cast<std::size_t>(supernodes_.place[node])] = true;
}

void LinearSystem::tie_up() {
  ties_.reserve(graph_->relations.size());
  for (std::uint32_t i = 0; i < graph_->relations.size(); ++i) {
    const GraphRelation& r = graph_->relations[i];
    Tie tie{r.a == kWorld ? -1 : supernodes_.place[r.a], supernodes_.place[r.b], i, 0};
    if (tie.a >= 0) {
      const std::int32_t column = std::min(tie.a, tie.b);
      const auto begin = H_.row.begin() + static_cast<std::ptrdiff_t>(H_.first[column]);
      const auto end = H_.row.begin() + static_cast<std::ptrdiff_t>(H_.first[column + 1]);
      tie.block = static_cast<std::size_t>(std::lower_bound(begin, end, std::max(tie.a, tie.b)) - H_.row.begin());
    }
    ties_.push_back(tie);
  }
  std::stable_sort(ties_.begin(), ties_.end(), [](const Tie& l, const Tie& r) { return l.block < r.block; });
  if (graph_->poses.size() > kManyPoses) return;
  turned_.reserve(ties_.size());
  for (const Tie& tie : ties_) {
    const auto* m = std::get_if<PosePose>(&graph_->relations[tie.relation].measurement);
    turned_.push_back(m != nullptr ? turned(*m) : TurnedPosePose{});
  }
}

LinearSystem::TurnedPosePose LinearSystem::turned(const PosePose& m) {
  Matrix3d turn = Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = m.T_a_b.rotation();
  const Matrix3d I = turn * m.information * turn.transpose();
  return {m.T_a_b.x, m.T_a_b.y, m.T_a_b.yaw, I(0, 0), I(1, 0), I(2, 0), I(1, 1), I(2, 1), I(2, 2)};
}

PairExpansion LinearSystem::expand_tie(std::size_t tie, const RelativePose& T_a_b) const {
  const Measurement& measurement = graph_->relations[ties_[tie].relation].measurement;
  const auto* pose_pose = std::get_if<PosePose>(&measurement);
  if (pose_pose == nullptr) return expand(measurement, T_a_b);
  const TurnedPosePose m = turned_.empty() ? turned(*pose_pose) : turned_[tie];
  const Vector3d e(T_a_b.x - m.x, T_a_b.y - m.y, wrap_small(T_a_b.yaw - m.yaw));
  Matrix3d information;
  information << m.xx, m.yx, m.ax, m.yx, m.yy, m.ay, m.ax, m.ay, m.aa;
  const Vector3d gradient = information * e;
  return {0.5 * e.dot(gradient), gradient, information};
}

std::vector<LinearSystem::Frame> LinearSystem::frames(std::span<const Pose2> poses) const {
  std::vector<Frame> result(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Pose2& T = poses[static_cast<std::size_t>(supernodes_.order[k])];
    result[k] = {T.x, T.y, T.yaw, std::cos(T.yaw), std::sin(T.yaw)};
  }
  return result;
}

RelativePose LinearSystem::relative(const Frame& a, const Frame& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  return {a.cosine * dx + a.sine * dy, a.cosine * dy - a.sine * dx, b.yaw - a.yaw,
          a.cosine * b.cosine + a.sine * b.sine, a.cosine * b.sine - a.sine * b.cosine};
}

double LinearSystem::cost(std::span<const Pose2> poses, const RobustLoss& loss) const {
  const std::vector<Frame> nodes = frames(poses);
  const Frame world{0, 0, 0, 1, 0};
  double sum = 0;
  for (std::size_t i = 0; i < ties_.size(); ++i) {
    const Tie& tie = ties_[i];
    PairExpansion pair = expand_tie(i, relative(tie.a < 0 ? world : nodes[tie.a], nodes[tie.b]));
    soften(graph_->relations[tie.relation], loss, pair);
    sum += pair.cost;
  }
  return sum;
}

double LinearSystem::linearise(std::span<const Pose2> poses, const RobustLoss& loss) {
  H_.set_zero();
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  const std::vector<Frame> nodes = frames(poses);
  const Frame world{0, 0, 0, 1, 0};
  double sum = 0;
  for (std::size_t i = 0; i < ties_.size(); ++i) {
    const Tie& tie = ties_[i];
    const RelativePose T_a_b = relative(tie.a < 0 ? world : nodes[tie.a], nodes[tie.b]);
    PairExpansion pair = expand_tie(i, T_a_b);
    soften(graph_->relations[tie.relation], loss, pair);
    sum += pair.cost;
    add(tie, pair, T_a_b);
  }
  close_fixed();
  return sum;
}

void LinearSystem::add(const Tie& tie, const PairExpansion& pair, const RelativePose& T_a_b) {
  using Block = Eigen::Map<Matrix3d>;
  using Segment = Eigen::Map<Vector3d>;
  const bool a_moves = tie.a >= 0 && !is_fixed_[static_cast<std::size_t>(tie.a)];
  const bool b_moves = !is_fixed_[static_cast<std::size_t>(tie.b)];
  auto [H_aa, H_bb, H_ab, g_a, g_b] = tie_blocks(pair, T_a_b);
  if (!has_no_heading_.empty()) {
    if (tie.a >= 0 && has_no_heading_[static_cast<std::size_t>(tie.a)]) drop_heading(H_aa, g_a), H_ab.row(2).setZero();
    if (has_no_heading_[static_cast<std::size_t>(tie.b)]) drop_heading(H_bb, g_b), H_ab.col(2).setZero();
  }
  if (a_moves) {
    Segment(gradient_.data() + kBlock * tie.a) += g_a;
    Block(H_.diagonal.data() + 9 * static_cast<std::size_t>(tie.a)) += H_aa;
  }
  if (b_moves) {
    Segment(gradient_.data() + kBlock * tie.b) += g_b;
    Block(H_.diagonal.data() + 9 * static_cast<std::size_t>(tie.b)) += H_bb;
  }
  if (!a_moves || !b_moves) return;
  if (tie.a > tie.b) {
    Block(H_.below.data() + 9 * tie.block) += H_ab;
  } else {
    Block(H_.below.data() + 9 * tie.block) += H_ab.transpose();
  }
}

void LinearSystem::close_fixed() {
  for (std::size_t k = 0; k < is_fixed_.size(); ++k) {
    double* block = H_.diagonal.data() + 9 * k;
    if (is_fixed_[k]) {
      block[0] = block[4] = block[8] = 1;
    } else if (!has_no_heading_.empty() && has_no_heading_[k]) {
      block[8] = 1;
    }
  }
}

std::vector<double> LinearSystem::newton_step() const {
  std::vector<double> step(gradient_.size());
  for (std::size_t i = 0; i < step.size(); ++i) step[i] = -gradient_[i];
  cholesky_.solve(step);
  return step;
}

Eigen::Matrix<double, 3, 6> relative_jacobian(const Pose2& T_a_b) {
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J.block<3, 3>(0, 0) = -Matrix3d::Identity();
  J(0, 2) = T_a_b.y;
  J(1, 2) = -T_a_b.x;
  J.block<2, 2>(0, 3) = T_a_b.rotation();
  J(2, 5) = 1;
  return J;
}

Matrix3d LinearSystem::relative_covariance(const Pose2& T_a_b, std::uint32_t a, std::uint32_t b) const {
  const Eigen::Matrix<double, 3, 6> J = relative_jacobian(T_a_b);
  const std::uint32_t ends[2] = {a, b};
  // With L Y = J^T the covariance is Y^T Y: half a solve, and never indefinite.
  std::vector<std::int32_t> places;
  std::vector<double> y[3];
  for (auto& column : y) column.assign(gradient_.size(), 0.0);
  for (int k = 0; k < 2; ++k) {
    if (ends[k] == kWorld || is_fixed(ends[k])) continue;
    places.push_back(supernodes_.place[ends[k]]);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < 3; ++i) y[c][offset(ends[k]) + static_cast<std::size_t>(i)] = J(c, 3 * k + i);
    }
  }
  Matrix3d covariance = Matrix3d::Zero();
  for (const std::int32_t k : cholesky_.forward_along(places, y)) {
    const Supernode& s = supernodes_.tree[k];
    const auto begin = kBlock * static_cast<std::size_t>(s.first);
    for (std::size_t i = begin; i < begin + kBlock * static_cast<std::size_t>(s.count); ++i) {
      const Vector3d row(y[0][i], y[1][i], y[2][i]);
      covariance += row * row.transpose();
    }
  }
  return covariance;
}

std::vector<Pose2> LinearSystem::moved(std::span<const Pose2> poses, std::span<const double> step, double scale) const {
  std::vector<Pose2> result(poses.begin(), poses.end());
  for (std::uint32_t i = 0; i < result.size(); ++i) {
    const double* xi = step.data() + offset(i);
    result[i] = result[i] * exponential(Vector3d(scale * xi[0], scale * xi[1], scale * xi[2]));
  }
  return result;
}

}  // namespace helicoid
