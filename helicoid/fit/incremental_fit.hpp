// A fit that follows a growing graph (incremental smoothing: Kaess et al. 2012): relations and poses that come and go
// cost what they change. Each pose is linearised where it stood when it last moved far (fluid relinearisation); only
// the part of the factor that a change concerns is eliminated again, and its solution is carried on as far as it
// matters. A step that raises the cost is taken back, and the whole graph is solved with damping instead.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/fit/clique_tree.hpp"
#include "helicoid/fit/fit_graph.hpp"

namespace helicoid {

struct IncrementalOptions {
  /// What bends a relation is a turn; of moves only their differences do, and neighbours move together.
  double relinearise_turn_beyond = 0.003;  ///< radians from where a pose is linearised
  double relinearise_move_beyond = 0.2;    ///< metres
  double propagate_beyond = 1e-4;          ///< metres, turns at kTurnReach: smaller changes are not carried on
  /// Multiplications that a step may spend on relinearising; what is left waits for the next step, farthest moved
  /// first.
  double most_work = 1e7;
  /// The share by which a step may raise the cost of the relations that it moves; half a residual's worth is always
  /// allowed. Beyond that the linear step was too long, and the whole graph is solved.
  double most_rise = 0.01;
  RobustLoss loss;  ///< acts on relations that may be wrong
};

/// What one update did.
struct IncrementalStep {
  std::size_t eliminated = 0;    ///< poses
  std::size_t relinearised = 0;  ///< poses
  std::size_t waiting = 0;       ///< poses that should be relinearised and were not
  std::size_t moved = 0;         ///< poses
  bool is_determined = true;     ///< false: relations leave poses open; those stay where they are
  bool solved_fully = false;     ///< the step raised the cost: it was taken back and the whole graph solved instead
};

/// The gauge is the caller's: some pose of every component is held, or tied to the world.
class IncrementalFit {
 public:
  explicit IncrementalFit(const IncrementalOptions& options = {}) : options_(options) {}

  /// `start` is T_plane_node. Poses are numbered as they come; so are relations.
  std::uint32_t add_pose(const Pose2& start, bool is_landmark = false);
  std::uint32_t add_relation(const GraphRelation& relation);
  /// From the next update on it is as if it had never been. Once only.
  void remove_relation(std::uint32_t relation);
  /// With all its relations; its number is not given again.
  void remove_pose(std::uint32_t node);
  /// Holds a pose where it is, or lets it go.
  void hold(std::uint32_t node, bool is_held = true);

  /// One Gauss-Newton step on what has changed; a full solve where that step would lead astray.
  IncrementalStep update();
  /// The fit of the whole graph, from where the poses are, for when it must be exact; the tree goes on from there.
  FitResult solve_fully(const FitOptions& options = {});

  /// T_plane_node as of the last update.
  [[nodiscard]] Pose2 pose(std::uint32_t node) const;
  /// Of all nodes; costs what the whole graph does.
  [[nodiscard]] std::vector<Pose2> poses() const;
  /// Chi^2 / 2 of these poses, with the loss. Looks at every relation.
  [[nodiscard]] double cost() const;

 private:
  struct Node {
    Pose2 linearised_at;  ///< T_plane_node
    double cosine = 1, sine = 0;
    std::vector<std::uint32_t> relations;
    bool is_landmark = false, is_held = false, is_removed = false;
    bool is_far = false;  ///< it is in far_
  };
  void linearise_at(std::uint32_t node, const Pose2& pose);
  void claim_around(std::uint32_t node);
  void list_far(std::uint32_t node);
  void relinearise(IncrementalStep& step);
  IncrementalStep step();
  /// From where the node is linearised.
  [[nodiscard]] Eigen::Map<Vector3d> twist(std::int32_t node) {
    return Eigen::Map<Vector3d>(delta_.data() + kBlock * static_cast<std::ptrdiff_t>(node));
  }
  /// 1: as far as what is linearised anew.
  [[nodiscard]] double distance(const Vector3d& twist) const;
  [[nodiscard]] double cost_around(std::span<const SolutionChange> nodes);
  [[nodiscard]] double cost_of(const GraphRelation& r) const;
  [[nodiscard]] bool take_back(std::vector<SolutionChange> changes);
  [[nodiscard]] PairExpansion expansion(const GraphRelation& r, const RelativePose& T_a_b) const;
  [[nodiscard]] RelativePose relative(const GraphRelation& r) const;
  [[nodiscard]] LooseSystem linearise(std::vector<std::int32_t> nodes);
  void add(const GraphRelation& r, LooseSystem& system) const;

  IncrementalOptions options_;
  std::vector<Node> nodes_;
  std::vector<double> delta_;  ///< twist from where each node is linearised
  std::vector<GraphRelation> relations_;
  std::vector<bool> is_removed_;       ///< of each relation
  std::vector<std::uint64_t> looked_;  ///< of each relation: the look that last saw it
  std::uint64_t looks_ = 0;
  std::vector<std::uint32_t> touched_;  ///< nodes whose relations changed
  std::vector<std::uint32_t> far_;      ///< nodes that may have moved far from where they are linearised
  std::vector<std::int32_t> loose_;     ///< nodes that the last update left open
  std::vector<std::int32_t> index_;     ///< of each node in the loose system; -1: not in it
  CliqueTree tree_;
};

}  // namespace helicoid
