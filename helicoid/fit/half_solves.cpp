#include "helicoid/fit/half_solves.hpp"

#include "helicoid/geometry/covariance.hpp"

namespace helicoid {

HalfSolves::HalfSolves(const LinearSystem& system, std::size_t most)
    : system_(system), most_(most), strips_(system.gradient().size() / kBlock) {
  const std::vector<Supernode>& tree = system.supernodes().tree;
  rows_to_.resize(tree.size());
  for (std::size_t k = tree.size(); k-- > 0;) {
    const Eigen::Index above = tree[k].parent < 0 ? 0 : rows_to_[static_cast<std::size_t>(tree[k].parent)];
    rows_to_[k] = above + kBlock * tree[k].count;
  }
  for (auto& column : columns_) column.assign(system.gradient().size(), 0.0);
}

HalfSolves::Strip HalfSolves::solve(std::uint32_t node) {
  const Supernodes& supernodes = system_.supernodes();
  const std::int32_t place = supernodes.place[node];
  Strip strip;
  strip.half.setZero(rows_to_[static_cast<std::size_t>(supernodes.of[place])], 3);
  if (system_.is_fixed(node)) return strip;
  for (std::size_t c = 0; c < 3; ++c) columns_[c][system_.offset(node) + c] = 1;
  const std::int32_t places[] = {place};
  for (const std::int32_t k : system_.factor().forward_along(places, columns_)) {
    const Supernode& s = supernodes.tree[k];
    const Eigen::Index rows = kBlock * s.count;
    for (int c = 0; c < 3; ++c) {
      Eigen::Map<Eigen::VectorXd> part(columns_[c].data() + kBlock * s.first, rows);
      strip.half.col(c).segment(rows_to_[static_cast<std::size_t>(k)] - rows, rows) = part;
      part.setZero();
    }
  }
  strip.square = strip.half.transpose().lazyProduct(strip.half);
  return strip;
}

const HalfSolves::Strip& HalfSolves::strip(std::uint32_t node) {
  Strip& kept = strips_[node];
  if (kept.half.rows() == 0) {
    kept = solve(node);
    kept_ += static_cast<std::size_t>(kept.half.size());
  }
  return kept;
}

Eigen::Index HalfSolves::common_rows(std::uint32_t a, std::uint32_t b) const {
  const Supernodes& supernodes = system_.supernodes();
  std::int32_t s = supernodes.of[supernodes.place[a]];
  std::int32_t t = supernodes.of[supernodes.place[b]];
  // Parents come after their children.
  while (s != t) {
    std::int32_t& lower = s < t ? s : t;
    lower = supernodes.tree[lower].parent;
    if (lower < 0) return 0;
  }
  return rows_to_[static_cast<std::size_t>(s)];
}

Matrix3d HalfSolves::relative_covariance(const Pose2& T_a_b, std::uint32_t a, std::uint32_t b) {
  if (kept_ > most_) {
    for (Strip& kept : strips_) kept = {};
    kept_ = 0;
  }
  const Strip& first = strip(a);
  const Strip& second = strip(b);
  const Eigen::Index rows = common_rows(a, b);
  Matrix3d cross;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) cross(i, j) = first.half.col(i).head(rows).dot(second.half.col(j).head(rows));
  }
  const Eigen::Matrix<double, 3, 6> J = relative_jacobian(T_a_b);
  const Matrix3d by_a = J.leftCols<3>();
  const Matrix3d by_b = J.rightCols<3>();
  const Matrix3d mixed = by_a * cross * by_b.transpose();
  return transport(by_a, first.square) + transport(by_b, second.square) + mixed + mixed.transpose();
}

}  // namespace helicoid
