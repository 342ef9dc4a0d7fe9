#include "helicoid/manifold/plane_index.hpp"

namespace helicoid {

void PlaneIndex::place(PatchId patch, IslandId island, const Vector2d& p_plane) {
  if (cell_of_patch_.size() <= patch.index()) cell_of_patch_.resize(patch.index() + 1, kNowhere);
  std::uint64_t& at = cell_of_patch_[patch.index()];
  const std::uint64_t now = key_of(island, cell_of(p_plane.x()), cell_of(p_plane.y()));
  if (at == now) return;
  if (at != kNowhere) {
    const auto left = cells_.find(at);
    std::erase(left->second, patch);
    if (left->second.empty()) cells_.erase(left);
  }
  at = now;
  cells_[now].push_back(patch);
}

}  // namespace helicoid
