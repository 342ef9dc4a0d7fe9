#include <algorithm>

#include "helicoid/fit/clique_tree.hpp"

namespace helicoid {

namespace {

/// A pivot that is less than this share of its own diagonal is rounding: the relations leave it open.
constexpr double kLeastPivot = 1e-14;

/// Target += 3 x 3 block; of a block on the diagonal the lower half.
void add_block(double* target, std::ptrdiff_t leading, const double* block, std::ptrdiff_t block_leading) {
  for (int j = 0; j < kBlock; ++j) {
    for (int i = 0; i < kBlock; ++i) target[i + j * leading] += block[i + j * block_leading];
  }
}
void add_transposed(double* target, std::ptrdiff_t leading, const double* block, std::ptrdiff_t block_leading) {
  for (int j = 0; j < kBlock; ++j) {
    for (int i = 0; i < kBlock; ++i) target[i + j * leading] += block[j + i * block_leading];
  }
}

}  // namespace

/// One elimination of loose nodes. Supernodes count in elimination order, `system` by index.
struct CliqueTree::Elimination {
  const LooseSystem* system;
  Supernodes supernodes;
  std::vector<std::vector<std::int32_t>> ties;     ///< of each supernode: indices in system->ties
  std::vector<std::vector<std::int32_t>> orphans;  ///< of each supernode: cliques that hang below it
  std::vector<std::int32_t> clique;                ///< of each supernode; -1: not eliminated
  std::vector<bool> has_failed;                    ///< a pivot of it or below it is not positive
  std::vector<std::vector<std::int32_t>> children;
  const std::vector<std::int32_t>* loose_at;

  [[nodiscard]] std::int32_t place_of(std::int32_t node) const { return supernodes.place[(*loose_at)[node]]; }
};

Supernodes CliqueTree::order(const LooseSystem& system) const {
  const auto count = static_cast<std::int32_t>(system.nodes.size());
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  for (const LooseSystem::Tie& tie : system.ties) pairs.emplace_back(tie.a, tie.b);
  for (const std::int32_t c : orphans_) {
    const auto& below = cliques_[c].below;
    for (std::size_t i = 0; i < below.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) pairs.emplace_back(loose_at_[below[i]], loose_at_[below[j]]);
    }
  }
  const Adjacency graph = find_adjacency(count, pairs);
  if (system.last < 0) return find_supernodes(graph, find_elimination_order(graph));
  std::erase_if(pairs, [&](const auto& p) { return p.first == system.last || p.second == system.last; });
  std::vector<std::int32_t> order = find_elimination_order(find_adjacency(count, pairs));
  std::erase(order, system.last);
  order.push_back(system.last);
  return find_supernodes(graph, order);
}

void CliqueTree::place_orphans(Elimination& e) {
  std::vector<std::int32_t> left;
  for (const std::int32_t c : orphans_) {
    std::int32_t first = e.supernodes.nodes();
    for (const std::int32_t node : cliques_[c].below) first = std::min(first, e.place_of(node));
    if (first < e.supernodes.nodes()) e.orphans[e.supernodes.of[first]].push_back(c);
  }
  orphans_.clear();
}

void CliqueTree::assemble(const Elimination& e, const Supernode& s, Clique& clique) const {
  const FrontShape shape = clique.shape();
  for (std::int32_t k = 0; k < s.count; ++k) {
    const std::int32_t index = e.supernodes.order[s.first + k];
    const std::int32_t corner = kBlock * k;
    add_block(clique.panel() + shape.panel_column(corner) + corner, between_columns(shape.leading(), corner),
              e.system->diagonal[index].data(), kBlock);
    for (int i = 0; i < kBlock; ++i) clique.right()[kBlock * k + i] -= e.system->gradient[index][i];
  }
  for (const std::int32_t t : e.ties[&s - e.supernodes.tree.data()]) {
    const LooseSystem::Tie& tie = e.system->ties[t];
    const std::int32_t a = e.supernodes.place[tie.a];
    const std::int32_t b = e.supernodes.place[tie.b];
    const std::int32_t column = kBlock * (std::min(a, b) - s.first);
    double* target = clique.panel() + shape.panel_column(column) + e.supernodes.panel_row(s, std::max(a, b));
    const std::ptrdiff_t leading = between_columns(shape.leading(), column);
    if (a > b) {
      add_block(target, leading, tie.block.data(), kBlock);
    } else {
      add_transposed(target, leading, tie.block.data(), kBlock);
    }
  }
}

void CliqueTree::add_child(const Clique& child, Clique& parent, const Elimination& e, const Supernode& s) const {
  const FrontShape shape = parent.shape();
  const FrontShape child_shape = child.shape();
  std::vector<std::int32_t> rows;
  rows.reserve(child.below.size());
  for (const std::int32_t node : child.below) rows.push_back(e.supernodes.panel_row(s, e.place_of(node)));
  for (std::size_t j = 0; j < rows.size(); ++j) {
    double* right = rows[j] < shape.first_below() ? parent.right() + rows[j]
                                                  : parent.right_below() + (rows[j] - shape.first_below());
    for (std::size_t i = 0; i < kBlock; ++i) right[i] += child.right_below()[kBlock * j + i];
    const auto from_column = kBlock * static_cast<std::int32_t>(j);
    const double* from = child.update() + child_shape.update_column(from_column);
    const std::ptrdiff_t from_leading = between_columns(padded(child_shape.below), from_column);
    for (std::size_t i = j; i < rows.size(); ++i) {
      const double* block = from + kBlock * i;
      // An older clique's nodes may now be eliminated in another order.
      const std::int32_t column = std::min(rows[i], rows[j]);
      const std::int32_t row = std::max(rows[i], rows[j]);
      const bool in_panel = column < shape.first_below();
      const std::int32_t above = in_panel ? 0 : shape.first_below();
      double* target = row - above +
                       (in_panel ? parent.panel() + shape.panel_column(column)
                                 : parent.update() + shape.update_column(column - above));
      const std::ptrdiff_t leading = between_columns(in_panel ? shape.leading() : padded(shape.below), column - above);
      if (rows[i] >= rows[j]) {
        add_block(target, leading, block, from_leading);
      } else {
        add_transposed(target, leading, block, from_leading);
      }
    }
  }
}

bool CliqueTree::eliminate_front(Elimination& e, std::int32_t supernode) {
  const Supernode& s = e.supernodes.tree[supernode];
  const std::int32_t id = new_clique();
  Clique& clique = cliques_[id];
  const auto node_at = [&](std::int32_t place) { return e.system->nodes[e.supernodes.order[place]]; };
  for (std::int32_t k = s.first; k < s.first + s.count; ++k) clique.pivots.push_back(node_at(k));
  for (const std::int32_t row : e.supernodes.rows_of(s)) clique.below.push_back(node_at(row));
  const FrontShape shape = clique.shape();
  const std::size_t size = shape.panel_size() + shape.update_size() + static_cast<std::size_t>(shape.leading());
  clique.numbers = WorkMemory(size);
  std::fill_n(clique.numbers.data(), size, 0.0);
  assemble(e, s, clique);
  for (const std::int32_t c : e.children[supernode]) add_child(cliques_[c], clique, e, s);
  for (const std::int32_t c : e.orphans[supernode]) add_child(cliques_[c], clique, e, s);
  if (workspace_.size() < shape.workspace_size()) workspace_ = WorkMemory(2 * shape.workspace_size());
  bool is_positive = front_kernels().eliminate(shape, clique.panel(), clique.update(), workspace_.data());
  for (int i = 0; i < shape.pivots && is_positive; ++i) {
    const double inverse = clique.panel()[shape.panel_column(i) + i];
    const Matrix3d& own = e.system->diagonal[e.supernodes.order[s.first + i / kBlock]];
    is_positive = 1 > kLeastPivot * inverse * inverse * own(i % kBlock, i % kBlock);
  }
  if (!is_positive) {
    forget(id);
    return false;
  }
  front_kernels().forward(shape, clique.panel(), clique.right(), clique.right_below());
  clique.made = round_;
  for (auto* list : {&e.children[supernode], &e.orphans[supernode]}) {
    for (const std::int32_t c : *list) {
      cliques_[c].parent = id;
      clique.children.push_back(c);
    }
  }
  for (const std::int32_t node : clique.pivots) clique_of_[node] = id;
  e.clique[supernode] = id;
  return true;
}

bool CliqueTree::eliminate(const LooseSystem& system) {
  ++round_;
  roots_.clear();
  for (std::size_t i = 0; i < system.nodes.size(); ++i) loose_at_[system.nodes[i]] = static_cast<std::int32_t>(i);
  Elimination e{&system, order(system), {}, {}, {}, {}, {}, &loose_at_};
  const std::size_t fronts = e.supernodes.tree.size();
  e.ties.resize(fronts);
  e.orphans.resize(fronts);
  e.children.resize(fronts);
  e.clique.assign(fronts, -1);
  e.has_failed.assign(fronts, false);
  for (std::size_t t = 0; t < system.ties.size(); ++t) {
    const LooseSystem::Tie& tie = system.ties[t];
    const std::int32_t first = std::min(e.supernodes.place[tie.a], e.supernodes.place[tie.b]);
    e.ties[e.supernodes.of[first]].push_back(static_cast<std::int32_t>(t));
  }
  place_orphans(e);
  bool is_whole = true;
  for (std::int32_t k = 0; k < static_cast<std::int32_t>(fronts); ++k) {
    const std::int32_t parent = e.supernodes.tree[k].parent;
    if (!e.has_failed[k] && eliminate_front(e, k)) {
      auto& list = parent >= 0 ? e.children[parent] : roots_;
      list.push_back(e.clique[k]);
      continue;
    }
    is_whole = false;
    if (parent >= 0) e.has_failed[parent] = true;
    for (const auto* list : {&e.children[k], &e.orphans[k]})
      orphans_.insert(orphans_.end(), list->begin(), list->end());
  }
  for (const std::int32_t node : system.nodes) loose_at_[node] = -1;
  return is_whole;
}

}  // namespace helicoid
