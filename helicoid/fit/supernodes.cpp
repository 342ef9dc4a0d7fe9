#include "helicoid/fit/supernodes.hpp"

#include <algorithm>
#include <numeric>

namespace helicoid {

namespace {

/// Elimination tree (Liu 1990): the parent of each node in elimination order, -1 for roots.
std::vector<std::int32_t> elimination_tree(const Adjacency& graph, std::span<const std::int32_t> order,
                                           std::span<const std::int32_t> place) {
  const auto nodes = static_cast<std::int32_t>(order.size());
  std::vector<std::int32_t> parent(order.size(), -1);
  std::vector<std::int32_t> ancestor(order.size(), -1);
  for (std::int32_t j = 0; j < nodes; ++j) {
    for (const std::int32_t neighbour : graph.of(order[j])) {
      // Path compression: what was climbed once points to j from now on.
      for (std::int32_t i = place[neighbour]; i != -1 && i < j;) {
        const std::int32_t next = ancestor[i];
        ancestor[i] = j;
        if (next == -1) parent[i] = j;
        i = next;
      }
    }
  }
  return parent;
}

/// The nodes of a forest, children before parents, each sub-tree together.
std::vector<std::int32_t> postorder(std::span<const std::int32_t> parent) {
  const auto nodes = static_cast<std::int32_t>(parent.size());
  std::vector<std::int32_t> child(parent.size(), -1);
  std::vector<std::int32_t> sibling(parent.size(), -1);
  for (std::int32_t i = nodes - 1; i >= 0; --i) {
    if (parent[i] < 0) continue;
    sibling[i] = child[parent[i]];
    child[parent[i]] = i;
  }
  std::vector<std::int32_t> order;
  order.reserve(parent.size());
  std::vector<std::int32_t> stack;
  for (std::int32_t root = 0; root < nodes; ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const std::int32_t node = stack.back();
      if (child[node] >= 0) {
        stack.push_back(child[node]);
        child[node] = sibling[child[node]];
      } else {
        order.push_back(node);
        stack.pop_back();
      }
    }
  }
  return order;
}

std::vector<std::int32_t> inverse_of(std::span<const std::int32_t> order) {
  std::vector<std::int32_t> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<std::int32_t>(k);
  return place;
}

/// A supernode while the tree is being made.
struct Group {
  std::vector<std::int32_t> columns;  ///< ascending
  std::vector<std::int32_t> rows;     ///< below, ascending
  std::int32_t parent = -1;
  std::int64_t zeros = 0;  ///< blocks that are stored but empty
  bool merged = false;     ///< into its parent
};

/// Columns whose structures nest without loss; the structure of each group only once.
class FundamentalGroups {
 public:
  FundamentalGroups(const Adjacency& graph, std::span<const std::int32_t> order, std::span<const std::int32_t> place,
                    std::span<const std::int32_t> parent)
      : graph_(graph), order_(order), place_(place), parent_(parent) {
    for (auto* list : {&group_of_, &stamp_, &child_}) list->assign(order.size(), -1);
    groups_.reserve(order.size());
    sibling_.reserve(order.size());
  }

  std::vector<Group> run() {
    for (std::int32_t j = 0; j < static_cast<std::int32_t>(order_.size()); ++j) {
      find_rows(j);
      add_column(j);
    }
    for (Group& group : groups_) std::sort(group.rows.begin(), group.rows.end());
    return std::move(groups_);
  }

 private:
  void find_rows(std::int32_t j) {
    rows_.clear();
    stamp_[j] = j;
    const auto add = [&](std::int32_t i) {
      if (i <= j || stamp_[i] == j) return;
      stamp_[i] = j;
      rows_.push_back(i);
    };
    for (const std::int32_t neighbour : graph_.of(order_[j])) add(place_[neighbour]);
    for (std::int32_t g = child_[j]; g >= 0; g = sibling_[g]) {
      for (const std::int32_t i : groups_[g].rows) add(i);
    }
  }

  /// To the group of the column before, if nothing is lost; otherwise to a new one.
  void add_column(std::int32_t j) {
    // In a postorder j - 1 is a child of j if j has any.
    const std::int32_t last = j > 0 && parent_[j - 1] == j ? group_of_[j - 1] : -1;
    if (last >= 0 && groups_[last].rows.size() == rows_.size() + 1) {
      group_of_[j] = last;
      groups_[last].columns.push_back(j);
      for (std::int32_t g = child_[j]; g >= 0; g = sibling_[g]) {
        if (g != last) groups_[g].parent = last;
      }
    } else {
      group_of_[j] = static_cast<std::int32_t>(groups_.size());
      for (std::int32_t g = child_[j]; g >= 0; g = sibling_[g]) groups_[g].parent = group_of_[j];
      groups_.push_back({{j}, {}, -1, 0, false});
      sibling_.push_back(-1);
    }
    groups_[group_of_[j]].rows.assign(rows_.begin(), rows_.end());
    if (parent_[j] < 0) return;
    sibling_[group_of_[j]] = child_[parent_[j]];
    child_[parent_[j]] = group_of_[j];
  }

  const Adjacency& graph_;
  std::span<const std::int32_t> order_;
  std::span<const std::int32_t> place_;
  std::span<const std::int32_t> parent_;
  std::vector<Group> groups_;
  std::vector<std::int32_t> group_of_;  ///< of each node
  std::vector<std::int32_t> stamp_;     ///< of each node; the column that last had it as a row
  std::vector<std::int32_t> child_;     ///< of each node; the groups that hang below it, as linked lists; -1 ends them
  std::vector<std::int32_t> sibling_;   ///< of each group
  std::vector<std::int32_t> rows_;      ///< of the column at hand
};

/// Is one front with some empty blocks cheaper than two? (Ashcraft and Grimes 1989.) Tiny fronts cost their call. Few
/// empty blocks are cheap in memory, too: twice or three times as many made no graph faster.
bool is_worth_merging(const Group& child, const Group& parent, std::int64_t zeros) {
  const auto columns = static_cast<std::int64_t>(child.columns.size() + parent.columns.size());
  const auto below = static_cast<std::int64_t>(parent.rows.size());
  const std::int64_t stored = columns * (columns + 1) / 2 + columns * below;
  if (columns <= 4) return 6 * zeros <= stored;
  if (columns <= 16) return 16 * zeros <= stored;
  return 64 * zeros <= stored;
}

/// Merges groups into their parents where that pays. Groups stand in postorder, so that columns come out sorted by it.
void merge_groups(std::vector<Group>& groups) {
  std::vector<std::vector<std::int32_t>> children(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    Group& group = groups[g];
    std::vector<std::pair<std::int64_t, std::int32_t>> candidates;
    for (const std::int32_t c : children[g]) {
      const Group& child = groups[c];
      const auto columns = static_cast<std::int64_t>(child.columns.size());
      const auto front = static_cast<std::int64_t>(group.columns.size() + group.rows.size());
      candidates.emplace_back(columns * (front - static_cast<std::int64_t>(child.rows.size())), c);
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [unused, c] : candidates) {
      Group& child = groups[c];
      const auto columns = static_cast<std::int64_t>(child.columns.size());
      const auto front = static_cast<std::int64_t>(group.columns.size() + group.rows.size());
      const std::int64_t zeros =
          group.zeros + child.zeros + columns * (front - static_cast<std::int64_t>(child.rows.size()));
      if (!is_worth_merging(child, group, zeros)) continue;
      child.merged = true;
      group.zeros = zeros;
      group.columns.insert(group.columns.begin(), child.columns.begin(), child.columns.end());
      std::vector<std::int32_t>().swap(child.rows);
    }
    if (group.parent >= 0) children[group.parent].push_back(static_cast<std::int32_t>(g));
  }
  // Who hung below a merged group hangs below what it was merged into.
  for (std::size_t g = groups.size(); g-- > 0;) {
    const std::int32_t parent = groups[g].parent;
    if (parent >= 0 && groups[parent].merged) groups[g].parent = groups[parent].parent;
  }
}

void append_runs(Supernodes& result, Supernode& s) {
  s.runs = result.runs.size();
  s.run_count = 0;
  if (s.parent < 0) return;
  const Supernode& parent = result.tree[s.parent];
  std::int32_t from = 0;
  for (const std::int32_t row : result.rows_of(s)) {
    const std::int32_t to = result.panel_row(parent, row);
    FrontRun* last = s.run_count > 0 ? &result.runs.back() : nullptr;
    const bool joins = last != nullptr && last->to + last->length == to &&
                       (to < parent.shape().first_below()) == (last->to < parent.shape().first_below());
    if (joins) {
      last->length += kBlock;
    } else {
      result.runs.push_back({from, to, kBlock});
      ++s.run_count;
    }
    from += kBlock;
  }
}

/// A parent comes after its children.
void set_depths(std::vector<Supernode>& tree) {
  for (std::size_t k = tree.size(); k-- > 0;) {
    tree[k].depth = tree[k].parent < 0 ? 0 : tree[tree[k].parent].depth + 1;
  }
}

/// Numbers the groups' columns anew, in a postorder of the merged tree, and lays out the fronts.
Supernodes lay_out(const std::vector<Group>& groups, std::span<const std::int32_t> order) {
  std::vector<std::int32_t> parent(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) parent[g] = groups[g].parent;
  Supernodes result;
  std::vector<std::int32_t> number(groups.size(), -1);
  std::vector<std::int32_t> renumbered(order.size());
  std::vector<std::int32_t> kept;
  for (const std::int32_t g : postorder(parent)) {
    if (groups[g].merged) continue;
    number[g] = static_cast<std::int32_t>(kept.size());
    kept.push_back(g);
    for (const std::int32_t column : groups[g].columns) {
      renumbered[column] = static_cast<std::int32_t>(result.order.size());
      result.order.push_back(order[column]);
    }
  }
  result.place = inverse_of(result.order);
  result.tree.resize(kept.size());
  result.of.resize(order.size());
  std::int32_t first = 0;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const Group& group = groups[kept[k]];
    Supernode& s = result.tree[k];
    s.first = first;
    s.count = static_cast<std::int32_t>(group.columns.size());
    s.parent = group.parent < 0 ? -1 : number[group.parent];
    std::fill_n(result.of.begin() + first, s.count, static_cast<std::int32_t>(k));
    first += s.count;
    s.rows = result.rows.size();
    s.below = static_cast<std::int32_t>(group.rows.size());
    for (const std::int32_t row : group.rows) result.rows.push_back(renumbered[row]);
    std::sort(result.rows.begin() + static_cast<std::ptrdiff_t>(s.rows), result.rows.end());
    s.panel = result.panels;
    result.panels += s.shape().panel_size();
  }
  set_depths(result.tree);
  for (Supernode& s : result.tree) append_runs(result, s);
  return result;
}

}  // namespace

std::int32_t Supernodes::panel_row(const Supernode& s, std::int32_t node) const {
  if (node < s.first + s.count) return kBlock * (node - s.first);
  const auto below = rows_of(s);
  const auto at = std::lower_bound(below.begin(), below.end(), node);
  return s.shape().first_below() + kBlock * static_cast<std::int32_t>(at - below.begin());
}

Supernodes find_supernodes(const Adjacency& graph, std::span<const std::int32_t> order) {
  std::vector<std::int32_t> place = inverse_of(order);
  const std::vector<std::int32_t> tree = elimination_tree(graph, order, place);
  const std::vector<std::int32_t> post = postorder(tree);
  std::vector<std::int32_t> refined(order.size());
  const std::vector<std::int32_t> renumbered = inverse_of(post);
  std::vector<std::int32_t> parent(order.size());
  for (std::size_t k = 0; k < post.size(); ++k) {
    refined[k] = order[post[k]];
    parent[k] = tree[post[k]] < 0 ? -1 : renumbered[tree[post[k]]];
  }
  place = inverse_of(refined);
  std::vector<Group> groups = FundamentalGroups(graph, refined, place, parent).run();
  merge_groups(groups);
  return lay_out(groups, refined);
}

}  // namespace helicoid
