// In which order to eliminate the unknowns of a graph, so that little fills in. The libraries AMD and METIS order; what
// is ours is to take the chains out first: a robot's path is mostly chain, and eliminating a pose between two others
// costs nothing.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace helicoid {

/// Who is tied to whom: the neighbours of node i are neighbours[first[i] .. first[i + 1]), ascending, each once, both
/// ways, without i itself.
struct Adjacency {
  std::vector<std::int32_t> first{0};
  std::vector<std::int32_t> neighbours;

  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(first.size()) - 1; }
  [[nodiscard]] std::span<const std::int32_t> of(std::int32_t node) const {
    return {neighbours.data() + first[node], static_cast<std::size_t>(first[node + 1] - first[node])};
  }
};

/// Pairs in any order and number; those of a node with itself are passed over.
[[nodiscard]] Adjacency find_adjacency(std::int32_t nodes,
                                       std::span<const std::pair<std::int32_t, std::int32_t>> pairs);

enum class Ordering : std::uint8_t {
  automatic,          ///< the next but one below some ten thousand nodes, the last above
  natural,            ///< as they are numbered
  minimum_degree,     ///< AMD (Amestoy, Davis and Duff 1996)
  nested_dissection,  ///< chains first, then METIS (Karypis and Kumar 1998)
};

/// order[k] is the node that is eliminated as k-th. The same graph gives the same order.
[[nodiscard]] std::vector<std::int32_t> find_elimination_order(const Adjacency& graph,
                                                               Ordering ordering = Ordering::automatic);

}  // namespace helicoid
