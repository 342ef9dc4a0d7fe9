#include "helicoid/fit/block_cholesky.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

void BlockMatrix::set_zero() {
  std::fill(diagonal.begin(), diagonal.end(), 0.0);
  std::fill(below.begin(), below.end(), 0.0);
}

BlockMatrix make_block_matrix(const Adjacency& graph, const Supernodes& supernodes) {
  BlockMatrix H;
  H.diagonal.assign(9 * supernodes.order.size(), 0.0);
  H.first.push_back(0);
  H.row.reserve(graph.neighbours.size() / 2);
  for (std::int32_t k = 0; k < supernodes.nodes(); ++k) {
    for (const std::int32_t neighbour : graph.of(supernodes.order[k])) {
      if (supernodes.place[neighbour] > k) H.row.push_back(supernodes.place[neighbour]);
    }
    std::sort(H.row.begin() + static_cast<std::ptrdiff_t>(H.first.back()), H.row.end());
    H.first.push_back(H.row.size());
  }
  H.below.assign(9 * H.row.size(), 0.0);
  return H;
}

std::vector<double> multiply(const BlockMatrix& H, std::span<const double> x) {
  std::vector<double> product(x.size(), 0.0);
  for (std::int32_t k = 0; k < H.nodes(); ++k) {
    const double* block = H.diagonal.data() + 9 * static_cast<std::size_t>(k);
    for (int j = 0; j < kBlock; ++j) {
      for (int i = 0; i < kBlock; ++i) product[kBlock * k + i] += block[i + 3 * j] * x[kBlock * k + j];
    }
    for (std::size_t e = H.first[k]; e < H.first[k + 1]; ++e) {
      block = H.below.data() + 9 * e;
      for (int j = 0; j < kBlock; ++j) {
        for (int i = 0; i < kBlock; ++i) {
          product[kBlock * H.row[e] + i] += block[i + 3 * j] * x[kBlock * k + j];
          product[kBlock * k + j] += block[i + 3 * j] * x[kBlock * H.row[e] + i];
        }
      }
    }
  }
  return product;
}

double relative_residual(const BlockMatrix& H, std::span<const double> x, std::span<const double> right) {
  const std::vector<double> left = multiply(H, x);
  double off = 0;
  double whole = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    off += (left[i] - right[i]) * (left[i] - right[i]);
    whole += right[i] * right[i];
  }
  return std::sqrt(off / whole);
}

BlockCholesky::BlockCholesky(const Supernodes& supernodes, const FrontKernels& kernels)
    : supernodes_(&supernodes), kernels_(&kernels) {
  // Parents follow their children, so that at a supernode its children's updates lie on top of the other depth's stack.
  std::size_t work = 0;
  std::size_t top[2] = {0, 0};
  std::size_t most[2] = {0, 0};
  std::size_t reach[2] = {0, 0};
  std::vector<std::size_t> released(supernodes.tree.size(), SIZE_MAX);
  update_at_.resize(supernodes.tree.size());
  for (std::size_t k = 0; k < supernodes.tree.size(); ++k) {
    const Supernode& s = supernodes.tree[k];
    work = std::max(work, s.shape().workspace_size());
    const int parity = s.depth % 2;
    update_at_[k] = top[parity];
    top[parity] += s.shape().update_size();
    for (int p = 0; p < 2; ++p) {
      most[p] = std::max(most[p], top[p]);
      reach[p] = std::max(reach[p], s.panel + s.shape().panel_size() + top[p]);
    }
    if (released[k] != SIZE_MAX) top[1 - parity] = released[k];
    if (s.parent >= 0) released[s.parent] = std::min(released[s.parent], update_at_[k]);
  }
  workspace_ = WorkMemory(work);
  within_ = reach[0] + most[1] < reach[1] + most[0] ? 0 : 1;
  panels_ = WorkMemory(reach[within_] + kStrip);
  stack_ = WorkMemory(most[1 - within_] + kStrip);
}

double* BlockCholesky::update_of(std::size_t k) const {
  const Supernode& s = supernodes_->tree[k];
  if (s.depth % 2 != within_) return stack_.data() + update_at_[k];
  return panels_.data() + (panels_.size() - kStrip - update_at_[k] - s.shape().update_size());
}

void BlockCholesky::prepare(const BlockMatrix& H) {
  if (block_at_.size() == H.row.size()) return;
  block_at_.resize(H.row.size());
  for (std::int32_t node = 0; node < H.nodes(); ++node) {
    const Supernode& s = supernodes_->tree[supernodes_->of[node]];
    const std::ptrdiff_t column =
        static_cast<std::ptrdiff_t>(s.panel) + s.shape().panel_column(kBlock * (node - s.first));
    for (std::size_t e = H.first[node]; e < H.first[node + 1]; ++e) {
      block_at_[e] = static_cast<std::size_t>(column + supernodes_->panel_row(s, H.row[e]));
    }
  }
}

void BlockCholesky::assemble(const BlockMatrix& H, const Supernode& s, double damping) {
  const FrontShape shape = s.shape();
  std::fill_n(panels_.data() + s.panel, shape.panel_size(), 0.0);
  for (std::int32_t node = s.first; node < s.first + s.count; ++node) {
    const std::int32_t local = kBlock * (node - s.first);
    const auto leading = static_cast<std::size_t>(between_columns(shape.leading(), local));
    double* block = panels_.data() + s.panel + shape.panel_column(local) + local;
    const double* from = H.diagonal.data() + 9 * static_cast<std::size_t>(node);
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 3; ++i) block[i + j * leading] = from[i + 3 * j];
      // Of what is not tied at all a share of nothing would be nothing.
      const double own = from[4 * j];
      block[j + j * leading] += damping * (own > 0 ? own : 1 + from[0] + from[4] + from[8]);
    }
    for (std::size_t e = H.first[node]; e < H.first[node + 1]; ++e) {
      double* place = panels_.data() + block_at_[e];
      const double* value = H.below.data() + 9 * e;
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t i = 0; i < 3; ++i) place[i + j * leading] = value[i + 3 * j];
      }
    }
  }
}

void BlockCholesky::add_update(const Supernode& child, const double* update, const Supernode& parent,
                               double* parent_update) {
  const FrontShape shape = parent.shape();
  const FrontShape child_shape = child.shape();
  const auto runs = supernodes_->runs_of(child);
  const std::int32_t first_below = shape.first_below();
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const FrontRun& columns = runs[r];
    const bool in_panel = columns.to < first_below;
    for (std::int32_t c = 0; c < columns.length; ++c) {
      const double* source = update + child_shape.update_column(columns.from + c);
      // Rows count from the top of the column: of the panel, or of what is below.
      double* target = in_panel ? panels_.data() + parent.panel + shape.panel_column(columns.to + c)
                                : parent_update + shape.update_column(columns.to + c - first_below) - first_below;
      for (std::int32_t i = c; i < columns.length; ++i) target[columns.to + i] += source[columns.from + i];
      for (std::size_t q = r + 1; q < runs.size(); ++q) {
        double* to = target + runs[q].to;
        const double* from = source + runs[q].from;
        const std::int32_t length = runs[q].length;
        for (std::int32_t i = 0; i < length; i += 3) {
          to[i] += from[i];
          to[i + 1] += from[i + 1];
          to[i + 2] += from[i + 2];
        }
      }
    }
  }
}

bool BlockCholesky::factorise(const BlockMatrix& H, double damping) {
  prepare(H);
  const auto& tree = supernodes_->tree;
  // Children of the supernode at hand are the last ones on the pending list.
  std::vector<std::int32_t> pending;
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const Supernode& s = tree[k];
    assemble(H, s, damping);
    double* update = update_of(k);
    std::fill_n(update, s.shape().update_size(), 0.0);
    for (; !pending.empty() && tree[pending.back()].parent == static_cast<std::int32_t>(k); pending.pop_back()) {
      const auto child = static_cast<std::size_t>(pending.back());
      add_update(tree[child], update_of(child), s, update);
    }
    if (!kernels_->eliminate(s.shape(), panels_.data() + s.panel, update, workspace_.data())) return false;
    if (s.parent >= 0) pending.push_back(static_cast<std::int32_t>(k));
  }
  return true;
}

void BlockCholesky::gather(const Supernode& s, std::span<const double> x, std::vector<double>& below) const {
  below.assign(static_cast<std::size_t>(padded(kBlock * s.below)), 0.0);
  double* to = below.data();
  for (const std::int32_t row : supernodes_->rows_of(s)) {
    const double* from = x.data() + kBlock * static_cast<std::size_t>(row);
    for (int i = 0; i < kBlock; ++i) *to++ = from[i];
  }
}

void BlockCholesky::forward(const Supernode& s, std::span<double> x, std::vector<double>& below) const {
  gather(s, x, below);
  kernels_->forward(s.shape(), panels_.data() + s.panel, x.data() + kBlock * s.first, below.data());
  const double* from = below.data();
  for (const std::int32_t row : supernodes_->rows_of(s)) {
    double* to = x.data() + kBlock * static_cast<std::size_t>(row);
    for (int i = 0; i < kBlock; ++i) to[i] = *from++;
  }
}

void BlockCholesky::solve(std::span<double> x) const {
  const auto& tree = supernodes_->tree;
  std::vector<double> below;
  for (const Supernode& s : tree) forward(s, x, below);
  for (std::size_t k = tree.size(); k-- > 0;) {
    gather(tree[k], x, below);
    kernels_->backward(tree[k].shape(), panels_.data() + tree[k].panel, x.data() + kBlock * tree[k].first,
                       below.data());
  }
}

std::vector<std::int32_t> BlockCholesky::forward_along(std::span<const std::int32_t> nodes,
                                                       std::span<std::vector<double>> columns) const {
  std::vector<std::int32_t> path;
  for (const std::int32_t node : nodes) {
    for (std::int32_t k = supernodes_->of[node]; k >= 0; k = supernodes_->tree[k].parent) path.push_back(k);
  }
  std::sort(path.begin(), path.end());
  path.erase(std::unique(path.begin(), path.end()), path.end());
  std::vector<double> below;
  for (const std::int32_t k : path) {
    for (std::vector<double>& x : columns) forward(supernodes_->tree[k], x, below);
  }
  return path;
}

}  // namespace helicoid
