#include "helicoid/fit/clique_tree.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

double CliqueTree::work_of(const Clique& clique) {
  const auto columns = static_cast<double>(kBlock * clique.pivots.size());
  const double height = columns + static_cast<double>(kBlock * clique.below.size());
  // Small fronts cost their bookkeeping: gathering children, memory, ordering.
  return columns * height * height + 4 * height * height + 3000;
}

double CliqueTree::claim(std::int32_t node) {
  double work = 0;
  for (std::int32_t c = clique_of_[node]; c >= 0 && !cliques_[c].is_claimed; c = cliques_[c].parent) {
    cliques_[c].is_claimed = true;
    claimed_.push_back(c);
    work += work_of(cliques_[c]);
  }
  return work;
}

double CliqueTree::work_to_claim(std::int32_t node) const {
  double work = 0;
  for (std::int32_t c = clique_of_[node]; c >= 0 && !cliques_[c].is_claimed; c = cliques_[c].parent) {
    work += work_of(cliques_[c]);
  }
  return work;
}

std::int32_t CliqueTree::new_clique() {
  if (free_.empty()) {
    cliques_.emplace_back();
    return static_cast<std::int32_t>(cliques_.size()) - 1;
  }
  const std::int32_t clique = free_.back();
  free_.pop_back();
  return clique;
}

void CliqueTree::forget(std::int32_t clique) {
  cliques_[clique] = {};
  free_.push_back(clique);
}

std::vector<std::int32_t> CliqueTree::release() {
  std::vector<std::int32_t> nodes;
  std::erase_if(orphans_, [&](std::int32_t c) { return cliques_[c].is_claimed; });
  for (const std::int32_t c : claimed_) {
    for (const std::int32_t child : cliques_[c].children) {
      if (cliques_[child].is_claimed) continue;
      cliques_[child].parent = -1;
      orphans_.push_back(child);
    }
    for (const std::int32_t node : cliques_[c].pivots) {
      clique_of_[node] = -1;
      nodes.push_back(node);
    }
  }
  for (const std::int32_t c : claimed_) forget(c);
  claimed_.clear();
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

void CliqueTree::substitute(const Clique& clique, std::span<double> x, double tolerance,
                            std::vector<SolutionChange>& changes) {
  const FrontShape shape = clique.shape();
  scratch_.assign(static_cast<std::size_t>(shape.leading()), 0.0);
  double* below = scratch_.data() + shape.first_below();
  std::copy_n(clique.right(), shape.pivots, scratch_.data());
  for (const std::int32_t node : clique.below) below = std::copy_n(x.data() + kBlock * node, kBlock, below);
  front_kernels().backward(shape, clique.panel(), scratch_.data(), scratch_.data() + shape.first_below());
  constexpr double reach[] = {1, 1, kTurnReach};
  const double* value = scratch_.data();
  for (const std::int32_t node : clique.pivots) {
    double* old = x.data() + kBlock * node;
    double change = 0;
    for (int i = 0; i < kBlock; ++i) change = std::max(change, reach[i] * std::abs(value[i] - old[i]));
    if (change > tolerance) {
      changes.push_back({node, {old[0], old[1], old[2]}});
      std::copy_n(value, kBlock, old);
      changed_[node] = round_;
    }
    value += kBlock;
  }
}

std::vector<SolutionChange> CliqueTree::back_substitute(std::span<double> x, double tolerance) {
  std::vector<SolutionChange> changes;
  std::vector<std::int32_t> stack = roots_;
  while (!stack.empty()) {
    const Clique& clique = cliques_[stack.back()];
    stack.pop_back();
    substitute(clique, x, tolerance, changes);
    for (const std::int32_t c : clique.children) {
      const Clique& child = cliques_[c];
      const bool concerned = child.made == round_ || std::any_of(child.below.begin(), child.below.end(),
                                                                 [&](auto node) { return changed_[node] == round_; });
      if (concerned) stack.push_back(c);
    }
  }
  return changes;
}

}  // namespace helicoid
