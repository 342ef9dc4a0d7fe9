// Sparse Cholesky factorisation of matrices of 3 x 3 blocks: multifrontal, by supernodes. Small fronts are what planar
// graphs are made of; general libraries spend their time on calls there.
#pragma once

#include <span>
#include <vector>

#include "helicoid/fit/supernodes.hpp"
#include "helicoid/fit/work_memory.hpp"

namespace helicoid {

/// A symmetric matrix of 3 x 3 blocks, column-major each, over the edges of a graph. Nodes in elimination order.
struct BlockMatrix {
  std::vector<double> diagonal;    ///< nine doubles a node; both halves
  std::vector<std::size_t> first;  ///< of each node's column, in `row`
  std::vector<std::int32_t> row;   ///< node below the diagonal, ascending in each column
  std::vector<double> below;       ///< nine doubles an entry of `row`

  [[nodiscard]] std::int32_t nodes() const { return static_cast<std::int32_t>(diagonal.size() / 9); }
  void set_zero();
};
/// All zeros, with room for the graph's edges.
[[nodiscard]] BlockMatrix make_block_matrix(const Adjacency& graph, const Supernodes& supernodes);

/// H x.
[[nodiscard]] std::vector<double> multiply(const BlockMatrix& H, std::span<const double> x);
/// |H x - right| / |right|: the proof of a solution.
[[nodiscard]] double relative_residual(const BlockMatrix& H, std::span<const double> x, std::span<const double> right);

class BlockCholesky {
 public:
  /// The supernodes outlive the factor.
  explicit BlockCholesky(const Supernodes& supernodes, const FrontKernels& kernels = front_kernels());

  /// Factorises H with its diagonal enlarged by this share (zeros on it too); false if that is not positive definite.
  bool factorise(const BlockMatrix& H, double damping = 0);
  /// H x = right, in place, in elimination order; three doubles a node.
  void solve(std::span<double> x) const;
  /// L y = x in place, for columns x that are zero but at these nodes: along their paths to the root, since y is zero
  /// elsewhere. The supernodes where it is not, ascending.
  std::vector<std::int32_t> forward_along(std::span<const std::int32_t> nodes,
                                          std::span<std::vector<double>> columns) const;
  /// The diagonal blocks of H^-1, nine doubles a node (selected inversion on the supernodes).
  [[nodiscard]] std::vector<double> inverse_diagonal() const;

  [[nodiscard]] const Supernodes& supernodes() const { return *supernodes_; }
  /// Doubles in the factor.
  [[nodiscard]] std::size_t size() const { return supernodes_->panels; }

 private:
  void assemble(const BlockMatrix& H, const Supernode& s, double damping);
  void add_update(const Supernode& child, const double* update, const Supernode& parent, double* parent_update);
  void prepare(const BlockMatrix& H);
  [[nodiscard]] double* update_of(std::size_t supernode) const;
  void gather(const Supernode& s, std::span<const double> x, std::vector<double>& below) const;
  void forward(const Supernode& s, std::span<double> x, std::vector<double>& below) const;

  const Supernodes* supernodes_;
  const FrontKernels* kernels_;
  /// Updates of supernodes of even and of odd depth lie on two stacks. One of them grows down from the end of the
  /// panels, where those are that are not made yet.
  WorkMemory panels_;
  WorkMemory stack_;  ///< the other
  WorkMemory workspace_;
  int within_ = 0;                      ///< which of the two stacks lies in the panels: 0, the even one, or 1
  std::vector<std::size_t> update_at_;  ///< how deep each supernode's update lies in its stack
  std::vector<std::size_t> block_at_;   ///< where each entry of H goes in the panels
};

}  // namespace helicoid
