// The relations linearised: gradient and expected information (eq. 8-9) as a matrix of blocks in elimination order.
// Unknowns are twists xi in each node's own frame, theta <- theta exp(xi): with the exponential, a turn of the whole
// graph is an exact step however long its levers are.
#pragma once

#include <span>
#include <vector>

#include "helicoid/fit/block_cholesky.hpp"
#include "helicoid/fit/relation_graph.hpp"
#include "helicoid/fit/robust_loss.hpp"

namespace helicoid {

/// The graph's shape and its symbolic factorisation; numbers come with `linearise`.
class LinearSystem {
 public:
  /// `fixed` nodes are held. The graph outlives the system; and stays as it is.
  LinearSystem(const RelationGraph& graph, std::span<const std::uint32_t> fixed,
               Ordering ordering = Ordering::automatic);
  LinearSystem(const LinearSystem&) = delete;
  LinearSystem& operator=(const LinearSystem&) = delete;

  /// Holds other nodes from the next `linearise` on; the symbolic phase is kept.
  void hold(std::span<const std::uint32_t> fixed);
  /// Cost (sum of losses / 2) at these poses; fills H and the gradient.
  double linearise(std::span<const Pose2> poses, const RobustLoss& loss = {});
  [[nodiscard]] double cost(std::span<const Pose2> poses, const RobustLoss& loss = {}) const;

  /// As BlockCholesky's.
  bool factorise(double damping = 0) { return cholesky_.factorise(H_, damping); }
  /// -H^-1 gradient, with the last factor. In elimination order, as the gradient; three numbers a node.
  [[nodiscard]] std::vector<double> newton_step() const;
  void solve(std::span<double> x) const { cholesky_.solve(x); }
  /// Covariance of T_a_b, its (x, y, yaw) in a's frame: J H^-1 J^T with the last factor (eq. 10); `a` may be the
  /// world. Costs the two nodes' paths to the root, not the graph.
  [[nodiscard]] Matrix3d relative_covariance(const Pose2& T_a_b, std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] std::vector<double> inverse_diagonal() const { return cholesky_.inverse_diagonal(); }

  [[nodiscard]] const BlockMatrix& information() const { return H_; }
  [[nodiscard]] std::span<const double> gradient() const { return gradient_; }
  [[nodiscard]] const Supernodes& supernodes() const { return supernodes_; }
  [[nodiscard]] const BlockCholesky& factor() const { return cholesky_; }
  [[nodiscard]] std::size_t factor_size() const { return cholesky_.size(); }
  /// Where a node's three numbers begin in steps and gradients.
  [[nodiscard]] std::size_t offset(std::uint32_t node) const {
    return kBlock * static_cast<std::size_t>(supernodes_.place[node]);
  }
  [[nodiscard]] bool is_fixed(std::uint32_t node) const {
    return is_fixed_[static_cast<std::size_t>(supernodes_.place[node])];
  }
  /// theta exp(scale * xi) for all nodes.
  [[nodiscard]] std::vector<Pose2> moved(std::span<const Pose2> poses, std::span<const double> step,
                                         double scale = 1) const;

 private:
  LinearSystem(const RelationGraph& graph, std::span<const std::uint32_t> fixed, const Adjacency& adjacency,
               Ordering ordering);

  /// A relation as linearising needs it; sorted by where it writes.
  struct Tie {
    std::int32_t a;  ///< places; -1 is the world
    std::int32_t b;
    std::uint32_t relation;
    std::size_t block;  ///< of H.below
  };
  struct Frame {
    double x, y, yaw, cosine, sine;
  };
  /// A pose-pose relation as it is used again and again: its residual turned into a's frame.
  struct TurnedPosePose {
    double x, y, yaw;
    double xx, yx, ax, yy, ay, aa;  ///< the information's lower half, `a` the angle; zero of other relations
  };
  void tie_up();
  [[nodiscard]] static TurnedPosePose turned(const PosePose& m);
  [[nodiscard]] PairExpansion expand_tie(std::size_t tie, const RelativePose& T_a_b) const;
  void add(const Tie& tie, const PairExpansion& pair, const RelativePose& T_a_b);
  [[nodiscard]] std::vector<Frame> frames(std::span<const Pose2> poses) const;
  [[nodiscard]] static RelativePose relative(const Frame& a, const Frame& b);
  void close_fixed();

  const RelationGraph* graph_;
  Supernodes supernodes_;
  BlockMatrix H_;
  std::vector<Tie> ties_;
  std::vector<TurnedPosePose> turned_;  ///< of each tie; empty where they are many: then turned each time
  std::vector<bool> is_fixed_;          ///< by place
  std::vector<bool> has_no_heading_;    ///< by place; empty if all have one
  std::vector<double> gradient_;
  BlockCholesky cholesky_;
};

/// Derivative of (t_x, t_y, phi) of T_a_b by the twists (xi_a, xi_b); 3 x 6.
[[nodiscard]] Eigen::Matrix<double, 3, 6> relative_jacobian(const Pose2& T_a_b);

}  // namespace helicoid
