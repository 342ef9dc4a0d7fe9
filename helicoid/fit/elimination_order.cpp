#include "helicoid/fit/elimination_order.hpp"

#include <amd.h>
#include <metis.h>

#include <algorithm>
#include <deque>
#include <mutex>
#include <numeric>

namespace helicoid {

namespace {

/// AMD takes less time than METIS and fills in no more below about this many nodes that are left of the chains.
constexpr std::int32_t kLargeGraph = 12000;

std::vector<std::int32_t> order_by_minimum_degree(const Adjacency& graph) {
  std::vector<std::int32_t> order(static_cast<std::size_t>(graph.size()));
  const int status =
      amd_order(graph.size(), graph.first.data(), graph.neighbours.data(), order.data(), nullptr, nullptr);
  // Out of memory is the only failure of a graph that is in order: any order is right, if dear.
  if (status != AMD_OK && status != AMD_OK_BUT_JUMBLED) std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<std::int32_t> order_by_dissection(Adjacency graph) {
  static_assert(sizeof(idx_t) == sizeof(std::int32_t));
  std::vector<std::int32_t> order(static_cast<std::size_t>(graph.size()));
  if (graph.neighbours.empty()) {
    std::iota(order.begin(), order.end(), 0);
    return order;
  }
  std::vector<std::int32_t> place(order.size());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_COMPRESS] = 0;
  idx_t nodes = graph.size();
  // METIS draws its random numbers from the C library's one sequence.
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  const int status =
      METIS_NodeND(&nodes, graph.first.data(), graph.neighbours.data(), nullptr, options, order.data(), place.data());
  return status == METIS_OK ? order : order_by_minimum_degree(graph);
}

/// A graph from which nodes with at most two ties are taken out, one by one; their neighbours become tied.
class ChainElimination {
 public:
  explicit ChainElimination(const Adjacency& graph) : ties_(static_cast<std::size_t>(graph.size())) {
    for (std::int32_t i = 0; i < graph.size(); ++i) {
      const auto neighbours = graph.of(i);
      ties_[i].assign(neighbours.begin(), neighbours.end());
    }
    gone_.assign(ties_.size(), false);
    for (std::int32_t i = 0; i < graph.size(); ++i) consider(i);
    while (!queue_.empty()) {
      const std::int32_t node = queue_.front();
      queue_.pop_front();
      if (!gone_[node]) eliminate(node);
    }
  }

  [[nodiscard]] const std::vector<std::int32_t>& eliminated() const { return order_; }

  /// What is left, and its nodes' numbers in the whole graph.
  [[nodiscard]] std::pair<Adjacency, std::vector<std::int32_t>> rest() const {
    std::vector<std::int32_t> nodes;
    std::vector<std::int32_t> number(ties_.size(), -1);
    for (std::size_t i = 0; i < ties_.size(); ++i) {
      if (gone_[i]) continue;
      number[i] = static_cast<std::int32_t>(nodes.size());
      nodes.push_back(static_cast<std::int32_t>(i));
    }
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
    for (const std::int32_t node : nodes) {
      for (const std::int32_t other : ties_[node]) {
        if (other > node) pairs.emplace_back(number[node], number[other]);
      }
    }
    return {find_adjacency(static_cast<std::int32_t>(nodes.size()), pairs), nodes};
  }

 private:
  /// Long lists are left alone: searching them again and again would cost the square of their length.
  static constexpr std::size_t kMostTies = 64;

  void consider(std::int32_t node) {
    if (gone_[node] || ties_[node].size() > 2) return;
    for (const std::int32_t other : ties_[node]) {
      if (ties_[other].size() > kMostTies) return;
    }
    queue_.push_back(node);
  }

  void replace(std::int32_t node, std::int32_t from, std::int32_t to) {
    auto& list = ties_[node];
    const auto at = std::find(list.begin(), list.end(), from);
    const bool known = to < 0 || std::find(list.begin(), list.end(), to) != list.end();
    if (known) {
      list.erase(at);
    } else {
      *at = to;
    }
  }

  void eliminate(std::int32_t node) {
    const std::vector<std::int32_t> ends = std::move(ties_[node]);
    ties_[node].clear();
    gone_[node] = true;
    order_.push_back(node);
    for (std::size_t k = 0; k < ends.size(); ++k) replace(ends[k], node, ends.size() == 2 ? ends[1 - k] : -1);
    for (const std::int32_t end : ends) consider(end);
  }

  std::vector<std::vector<std::int32_t>> ties_;
  std::vector<bool> gone_;
  std::deque<std::int32_t> queue_;
  std::vector<std::int32_t> order_;
};

std::vector<std::int32_t> order_large(const Adjacency& graph) {
  const ChainElimination chains(graph);
  std::vector<std::int32_t> order = chains.eliminated();
  const auto [rest, nodes] = chains.rest();
  for (const std::int32_t node : order_by_dissection(rest)) order.push_back(nodes[node]);
  return order;
}

}  // namespace

Adjacency find_adjacency(std::int32_t nodes, std::span<const std::pair<std::int32_t, std::int32_t>> pairs) {
  const auto count = static_cast<std::size_t>(nodes);
  // Twice by counting: rows in order of columns, then columns in order of rows, so that lists come out ascending.
  std::vector<std::int32_t> first(count + 1, 0);
  for (const auto& [a, b] : pairs) {
    if (a == b) continue;
    ++first[a + 1];
    ++first[b + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::int32_t> jumbled(static_cast<std::size_t>(first[count]));
  std::vector<std::int32_t> next(first.begin(), first.end() - 1);
  for (const auto& [a, b] : pairs) {
    if (a == b) continue;
    jumbled[next[a]++] = b;
    jumbled[next[b]++] = a;
  }
  std::vector<std::int32_t> sorted(jumbled.size());
  next.assign(first.begin(), first.end() - 1);
  for (std::int32_t i = 0; i < nodes; ++i) {
    for (std::int32_t at = first[i]; at < first[i + 1]; ++at) sorted[next[jumbled[at]]++] = i;
  }
  Adjacency graph;
  graph.first.assign(count + 1, 0);
  graph.neighbours.reserve(sorted.size());
  for (std::int32_t i = 0; i < nodes; ++i) {
    for (std::int32_t at = first[i]; at < first[i + 1]; ++at) {
      if (at == first[i] || sorted[at] != sorted[at - 1]) graph.neighbours.push_back(sorted[at]);
    }
    graph.first[i + 1] = static_cast<std::int32_t>(graph.neighbours.size());
  }
  return graph;
}

std::vector<std::int32_t> find_elimination_order(const Adjacency& graph, Ordering ordering) {
  if (ordering == Ordering::automatic) {
    ordering = graph.size() < kLargeGraph ? Ordering::minimum_degree : Ordering::nested_dissection;
  }
  if (ordering == Ordering::minimum_degree) return order_by_minimum_degree(graph);
  if (ordering == Ordering::nested_dissection) return order_large(graph);
  std::vector<std::int32_t> order(static_cast<std::size_t>(graph.size()));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

}  // namespace helicoid
