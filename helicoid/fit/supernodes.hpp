// The symbolic phase of the factorisation: which columns are eliminated together and where their fronts go. It depends
// on the graph alone and is kept while only numbers change.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/fit/elimination_order.hpp"
#include "helicoid/fit/front_kernels.hpp"

namespace helicoid {

/// Every node is a block of so many unknowns; one that has fewer (a landmark) holds the rest fixed.
inline constexpr int kBlock = 3;

/// Consecutive unknowns of a child's update that are consecutive in its parent's front too. Scalars.
struct FrontRun {
  std::int32_t from = 0;    ///< row of the child's update
  std::int32_t to = 0;      ///< row of the parent's panel: padded(pivots) lies between its last pivot and what is below
  std::int32_t length = 0;  ///< rows
};

/// Columns that have the same rows beneath them and are eliminated in one front (Liu, Ng and Peyton 1993). Nodes are
/// counted in elimination order.
struct Supernode {
  std::int32_t first = 0;    ///< its first node
  std::int32_t count = 0;    ///< its nodes are [first, first + count)
  std::int32_t parent = -1;  ///< the supernode that its update is added to; -1 for a root
  std::int32_t depth = 0;    ///< below its root
  std::size_t rows = 0;      ///< where its rows below begin, in Supernodes::rows
  std::int32_t below = 0;    ///< how many nodes
  std::size_t runs = 0;      ///< where its runs begin, in Supernodes::runs
  std::int32_t run_count = 0;
  std::size_t panel = 0;  ///< where its panel begins, in doubles

  [[nodiscard]] FrontShape shape() const { return {kBlock * count, kBlock * below}; }
};

/// The tree of supernodes, children before parents.
struct Supernodes {
  std::vector<std::int32_t> order;  ///< order[k] is the node of the graph that is the k-th in elimination order
  std::vector<std::int32_t> place;  ///< its inverse
  std::vector<Supernode> tree;
  std::vector<std::int32_t> of;    ///< the supernode of the k-th node
  std::vector<std::int32_t> rows;  ///< ascending, of each supernode
  std::vector<FrontRun> runs;
  std::size_t panels = 0;  ///< all panels together, in doubles

  [[nodiscard]] std::int32_t nodes() const { return static_cast<std::int32_t>(order.size()); }
  [[nodiscard]] std::span<const std::int32_t> rows_of(const Supernode& s) const {
    return {rows.data() + s.rows, static_cast<std::size_t>(s.below)};
  }
  [[nodiscard]] std::span<const FrontRun> runs_of(const Supernode& s) const {
    return {runs.data() + s.runs, static_cast<std::size_t>(s.run_count)};
  }
  /// Row of s's panel at which a node begins; the node is one of s or of its rows.
  [[nodiscard]] std::int32_t panel_row(const Supernode& s, std::int32_t node) const;
};

/// The supernodes of eliminating the graph's nodes in this order. The order is refined: it becomes a postorder of the
/// tree, which fills in exactly as much.
[[nodiscard]] Supernodes find_supernodes(const Adjacency& graph, std::span<const std::int32_t> order);

}  // namespace helicoid
