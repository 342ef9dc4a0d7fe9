// The inverse's diagonal blocks, from the roots down: a front's rows below are rows of its parent's front, whose part
// of the inverse is known by then.
#include <algorithm>

#include "helicoid/fit/block_cholesky.hpp"

namespace helicoid {

namespace {

std::size_t front_size(const Supernode& s) {
  const auto leading = static_cast<std::size_t>(s.shape().leading());
  return leading * leading;
}

/// Copies what the child's rows below are in the parent's inverse to the child's lower right corner.
void take_corner(std::span<const FrontRun> runs, const Supernode& child, double* inverse, const Supernode& parent,
                 const double* parent_inverse) {
  const std::ptrdiff_t leading = child.shape().leading();
  const std::ptrdiff_t parent_leading = parent.shape().leading();
  const std::ptrdiff_t corner = child.shape().first_below() * (leading + 1);
  double* to = inverse + corner;
  for (const FrontRun& columns : runs) {
    for (std::int32_t c = 0; c < columns.length; ++c) {
      for (const FrontRun& rows : runs) {
        const double* source = parent_inverse + (columns.to + c) * parent_leading + rows.to;
        double* target = to + (columns.from + c) * leading + rows.from;
        for (std::int32_t i = 0; i < rows.length; ++i) target[i] = source[i];
      }
    }
  }
}

}  // namespace

std::vector<double> BlockCholesky::inverse_diagonal() const {
  const auto& tree = supernodes_->tree;
  std::vector<double> result(9 * static_cast<std::size_t>(supernodes_->nodes()));
  const WorkMemory workspace(workspace_.size());
  // The fronts from a root to the supernode at hand; parents stand at known places, since the order is a preorder.
  std::vector<std::size_t> at(tree.size());
  std::size_t most = 0;
  for (std::size_t k = tree.size(); k-- > 0;) {
    const auto parent = static_cast<std::size_t>(tree[k].parent);
    at[k] = tree[k].parent < 0 ? 0 : at[parent] + front_size(tree[parent]);
    most = std::max(most, at[k] + front_size(tree[k]));
  }
  const WorkMemory stack(most);
  for (std::size_t k = tree.size(); k-- > 0;) {
    const Supernode& s = tree[k];
    const auto parent = static_cast<std::size_t>(s.parent);
    double* inverse = stack.data() + at[k];
    std::fill_n(inverse, front_size(s), 0.0);
    if (s.parent >= 0) take_corner(supernodes_->runs_of(s), s, inverse, tree[parent], stack.data() + at[parent]);
    kernels_->invert(s.shape(), panels_.data() + s.panel, inverse, workspace.data());
    const std::ptrdiff_t leading = s.shape().leading();
    for (std::int32_t node = 0; node < s.count; ++node) {
      double* to = result.data() + 9 * static_cast<std::size_t>(s.first + node);
      const double* from = inverse + kBlock * node * (leading + 1);
      for (std::ptrdiff_t j = 0; j < 3; ++j) {
        for (std::ptrdiff_t i = 0; i < 3; ++i) to[i + 3 * j] = from[i + j * leading];
      }
    }
  }
  return result;
}

}  // namespace helicoid
