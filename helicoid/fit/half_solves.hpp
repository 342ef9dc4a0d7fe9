// L^-1 E of single nodes, kept: with it the covariance of a pair is a product of two short strips, where a solve would
// walk the factor for every pair anew.
#pragma once

#include <vector>

#include "helicoid/fit/linear_system.hpp"

namespace helicoid {

class HalfSolves {
 public:
  /// The system is factorised, stays as it is and outlives this. Strips take `most` doubles at most together.
  explicit HalfSolves(const LinearSystem& system, std::size_t most = std::size_t{1} << 23);

  /// As LinearSystem's, a and b two different nodes.
  [[nodiscard]] Matrix3d relative_covariance(const Pose2& T_a_b, std::uint32_t a, std::uint32_t b);

 private:
  /// Of one node: L^-1 of its three unknowns where it is not zero, which is from the root down to the node's supernode.
  /// Root first, so that two nodes' strips begin with the supernodes that both lie below.
  struct Strip {
    Eigen::Matrix<double, Eigen::Dynamic, 3> half;
    Matrix3d square = Matrix3d::Zero();  ///< half^T half: the node's own covariance
  };
  const Strip& strip(std::uint32_t node);
  [[nodiscard]] Strip solve(std::uint32_t node);
  [[nodiscard]] Eigen::Index common_rows(std::uint32_t a, std::uint32_t b) const;

  const LinearSystem& system_;
  std::size_t most_;
  std::size_t kept_ = 0;
  std::vector<Strip> strips_;          ///< by node; empty: not at hand
  std::vector<Eigen::Index> rows_to_;  ///< by supernode: rows from the root down to it, its own included
  std::vector<double> columns_[3];     ///< all zero between two solves
};

}  // namespace helicoid
