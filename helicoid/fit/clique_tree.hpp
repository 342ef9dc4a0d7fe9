// The factor of a linear system that grows and shrinks, as a tree of cliques (the Bayes tree of Kaess et al. 2012): the
// fronts of the multifrontal factorisation, each kept together with what it passed on. A change concerns the cliques of
// the nodes it touches and their ancestors up to the root; those are taken out, ordered anew and eliminated again, and
// the sub-trees below them stay as they are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/fit/supernodes.hpp"
#include "helicoid/fit/work_memory.hpp"
#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// The system of the nodes that are in no clique. Three unknowns a node.
struct LooseSystem {
  struct Tie {
    std::int32_t a, b;  ///< indices in `nodes`
    Matrix3d block;     ///< row a, column b
  };
  std::vector<std::int32_t> nodes;  ///< ascending
  std::vector<Matrix3d> diagonal;   ///< of each
  std::vector<Vector3d> gradient;   ///< of each
  std::vector<Tie> ties;
  std::int32_t last = -1;  ///< index of the node that is eliminated last, as it will change next; -1: any
};

/// Turns count as the move that they make at this distance, metres.
inline constexpr double kTurnReach = 10;

/// A node whose solution changed, and what it was before.
struct SolutionChange {
  std::int32_t node = 0;
  Vector3d before;
};

class CliqueTree {
 public:
  /// A new node, in no clique.
  void add_node() { clique_of_.push_back(-1), loose_at_.push_back(-1), changed_.push_back(0); }
  /// Whether the node is in a clique.
  [[nodiscard]] bool holds(std::int32_t node) const { return clique_of_[node] >= 0; }

  /// Marks the cliques that a change of this node concerns; gives the work of eliminating those that were not marked
  /// yet, in multiplications.
  double claim(std::int32_t node);
  /// The same work, without marking.
  [[nodiscard]] double work_to_claim(std::int32_t node) const;
  /// Takes the marked cliques out. Their nodes, ascending.
  [[nodiscard]] std::vector<std::int32_t> release();

  /// Makes cliques of loose nodes. What depends on a pivot that is not positive stays loose; false if something does.
  bool eliminate(const LooseSystem& system);
  /// H x = -gradient, from the roots down as far as some x changes by more than the tolerance; x has three numbers a
  /// node.
  [[nodiscard]] std::vector<SolutionChange> back_substitute(std::span<double> x, double tolerance);

 private:
  /// panel | update | pivots' right side | right side passed on.
  struct Clique {
    std::vector<std::int32_t> pivots;  ///< nodes, in elimination order
    std::vector<std::int32_t> below;   ///< nodes that its update is about, in elimination order
    WorkMemory numbers;
    std::int32_t parent = -1;
    std::vector<std::int32_t> children;
    std::uint64_t made = 0;  ///< the elimination that made it
    bool is_claimed = false;

    [[nodiscard]] FrontShape shape() const {
      return {kBlock * static_cast<int>(pivots.size()), kBlock * static_cast<int>(below.size())};
    }
    [[nodiscard]] double* panel() const { return numbers.data(); }
    [[nodiscard]] double* update() const { return panel() + shape().panel_size(); }
    [[nodiscard]] double* right() const { return update() + shape().update_size(); }
    [[nodiscard]] double* right_below() const { return right() + padded(shape().pivots); }
  };
  struct Elimination;

  [[nodiscard]] static double work_of(const Clique& clique);
  [[nodiscard]] std::int32_t new_clique();
  void forget(std::int32_t clique);
  [[nodiscard]] Supernodes order(const LooseSystem& system) const;
  void place_orphans(Elimination& elimination);
  void assemble(const Elimination& elimination, const Supernode& s, Clique& clique) const;
  void add_child(const Clique& child, Clique& parent, const Elimination& elimination, const Supernode& s) const;
  [[nodiscard]] bool eliminate_front(Elimination& elimination, std::int32_t supernode);
  void substitute(const Clique& clique, std::span<double> x, double tolerance, std::vector<SolutionChange>& changes);

  std::vector<Clique> cliques_;
  std::vector<std::int32_t> free_;       ///< cliques_ that stand empty
  std::vector<std::int32_t> claimed_;    ///< cliques
  std::vector<std::int32_t> orphans_;    ///< cliques whose parent was taken out
  std::vector<std::int32_t> roots_;      ///< of the last elimination
  std::vector<std::int32_t> clique_of_;  ///< of each node; -1: loose
  std::vector<std::int32_t> loose_at_;   ///< of each node; its index in the loose system while that is eliminated
  std::vector<std::uint64_t> changed_;   ///< the back-substitution that last changed each node
  std::uint64_t round_ = 0;
  WorkMemory workspace_;
  std::vector<double> scratch_;
};

}  // namespace helicoid
