#include "helicoid/navigation/floor_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace helicoid {

namespace {

auto key_of(const FloorTile& tile) {
  return std::tuple(tile.island, tile.block);
}

/// The tiles of one block.
std::span<const std::shared_ptr<const FloorTile>> tiles_over(const std::vector<std::shared_ptr<const FloorTile>>& tiles,
                                                             IslandId island, const FloorBlock& block) {
  const auto key = std::tuple(island, block);
  const auto first = std::lower_bound(tiles.begin(), tiles.end(), key,
                                      [](const auto& tile, const auto& wanted) { return key_of(*tile) < wanted; });
  auto last = first;
  while (last != tiles.end() && key_of(**last) == key) ++last;
  return {first, last};
}

bool share_a_patch(const FloorTile& a, const FloorTile& b) {
  for (auto i = a.patches.begin(), j = b.patches.begin(); i != a.patches.end() && j != b.patches.end();) {
    if (*i == *j) return true;
    *i < *j ? ++i : ++j;
  }
  return false;
}

/// Sorts the patches over a block into groups that chains of neighbours join.
class Grouping {
 public:
  Grouping(std::size_t patches, const Neighbours& neighbours) : neighbours_(neighbours), place_(patches, kNowhere) {}

  /// Groups in the order of their first patches; patches ascend.
  std::vector<std::vector<PatchId>> groups(std::span<const PatchId> patches) {
    std::vector<std::uint32_t> root(patches.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&root](std::uint32_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    for (std::uint32_t i = 0; i < patches.size(); ++i) place_[patches[i].index()] = i;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      for (const PatchId next : neighbours_[patches[i].index()]) {
        if (next > patches[i]) break;
        if (place_[next.index()] == kNowhere) continue;
        const std::uint32_t a = find(i);
        const std::uint32_t b = find(place_[next.index()]);
        root[std::max(a, b)] = std::min(a, b);
      }
    }
    std::vector<std::vector<PatchId>> result;
    std::vector<std::size_t> group_of(patches.size());
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      const std::uint32_t first = find(i);
      if (first == i) {
        group_of[i] = result.size();
        result.emplace_back();
      }
      result[group_of[first]].push_back(patches[i]);
      place_[patches[i].index()] = kNowhere;
    }
    return result;
  }

 private:
  static constexpr std::uint32_t kNowhere = static_cast<std::uint32_t>(-1);
  const Neighbours& neighbours_;
  std::vector<std::uint32_t> place_;  ///< by patch: among those that are grouped
};

void raster_patches(FloorPlan& plan, const Map& map, const FloorPlan* before) {
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const auto id = make_id<PatchId>(i);
    const Patch& patch = map.patch(id);
    const Pose2& pose = map.T_plane_patch(id);
    std::vector<Vector2d> bystanders = plan.bystanders.about(map, id);
    if (before != nullptr && i < before->rasters.size() && before->rasters[i]->holds(patch, pose, bystanders)) {
      plan.rasters.push_back(before->rasters[i]);
    } else {
      plan.rasters.push_back(
          std::make_shared<const PatchRaster>(make_patch_raster(patch, pose, std::move(bystanders))));
    }
  }
}

/// Neighbours, and what a robot drove from one to the next: it was all floor, however weakly scans tell how long.
Neighbours with_ways(const Map& map, const Neighbours& neighbours) {
  Neighbours joined = neighbours;
  joined.resize(map.patch_count());
  for (const Relation& relation : map.relations()) {
    if (relation.kind != RelationKind::odometry) continue;
    joined[relation.a.index()].push_back(relation.b);
    joined[relation.b.index()].push_back(relation.a);
  }
  for (std::vector<PatchId>& of_patch : joined) std::sort(of_patch.begin(), of_patch.end());
  return joined;
}

/// Tiles with their patches, not laid yet.
std::vector<FloorTile> group_patches(const FloorPlan& plan, const Neighbours& neighbours) {
  struct Entry {
    IslandId island;
    FloorBlock block;
    PatchId patch;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < plan.rasters.size(); ++i) {
    for (const auto& part : plan.rasters[i]->parts) {
      entries.push_back({plan.island_of[i], part.block, make_id<PatchId>(i)});
    }
  }
  std::sort(entries.begin(), entries.end());
  Grouping grouping(plan.rasters.size(), neighbours);
  std::vector<FloorTile> tiles;
  std::vector<PatchId> over;
  for (std::size_t i = 0; i < entries.size(); i += over.size()) {
    over.clear();
    for (std::size_t k = i;
         k < entries.size() && entries[k].island == entries[i].island && entries[k].block == entries[i].block; ++k) {
      over.push_back(entries[k].patch);
    }
    for (std::vector<PatchId>& group : grouping.groups(over)) {
      FloorTile& tile = tiles.emplace_back();
      tile.island = entries[i].island;
      tile.block = entries[i].block;
      tile.patches = std::move(group);
      for (const PatchId id : tile.patches) tile.rasters.push_back(plan.rasters[id.index()]);
    }
  }
  return tiles;
}

/// The tile of a block on which a patch is; none: the end.
template <class Tiles>
auto tile_with(Tiles& tiles, IslandId island, const FloorBlock& block, PatchId patch) {
  const auto get = [](auto& tile) -> const FloorTile& {
    if constexpr (requires { *tile; }) {
      return *tile;
    } else {
      return tile;
    }
  };
  const auto key = std::tuple(island, block);
  auto at = std::lower_bound(tiles.begin(), tiles.end(), key,
                             [&](auto& tile, const auto& wanted) { return key_of(get(tile)) < wanted; });
  for (; at != tiles.end() && key_of(get(*at)) == key; ++at) {
    const std::vector<PatchId>& patches = get(*at).patches;
    if (std::binary_search(patches.begin(), patches.end(), patch)) return at;
  }
  return tiles.end();
}

void put_footsteps(const FloorPlan& plan, std::vector<FloorTile>& tiles) {
  for (const ManifoldPoint& step : plan.footsteps.points()) {
    const Vector2d p = plan.T_plane_patch[step.patch.index()] * step.p_patch;
    const std::int32_t column = cell_of(p.x());
    const std::int32_t row = cell_of(p.y());
    for (std::int32_t r = first_block_about(row); r <= last_block_about(row); ++r) {
      for (std::int32_t c = first_block_about(column); c <= last_block_about(column); ++c) {
        const auto at = tile_with(tiles, plan.island_of[step.patch.index()], {c, r}, step.patch);
        if (at != tiles.end()) at->footsteps.emplace_back(p - at->block.halo_corner());
      }
    }
  }
}

/// A tile of before that is made of the same: footsteps are only ever added.
std::shared_ptr<const FloorTile> same_tile(const FloorPlan& before, const FloorTile& tile) {
  for (const auto& old : tiles_over(before.tiles, tile.island, tile.block)) {
    if (old->patches == tile.patches && old->rasters == tile.rasters && old->footsteps.size() == tile.footsteps.size())
      return old;
  }
  return nullptr;
}

void join_tiles(FloorPlan& plan) {
  plan.beside.resize(plan.tiles.size());
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    const FloorTile& tile = *plan.tiles[i];
    for (int direction = 0; direction < 9; ++direction) {
      if (direction == 4) continue;
      const FloorBlock block{tile.block.column + direction % 3 - 1, tile.block.row + direction / 3 - 1};
      const auto over = tiles_over(plan.tiles, tile.island, block);
      for (const auto& other : over) {
        if (!share_a_patch(tile, *other)) continue;
        plan.beside[i][static_cast<std::size_t>(direction)].push_back(
            static_cast<std::uint32_t>(&other - plan.tiles.data()));
      }
    }
  }
}

}  // namespace

std::optional<FloorPlace> FloorPlan::locate(const ManifoldPoint& point) const {
  if (!point.patch.valid() || point.patch.index() >= T_plane_patch.size()) return std::nullopt;
  const Vector2d p = T_plane_patch[point.patch.index()] * point.p_patch;
  const std::int32_t column = cell_of(p.x());
  const std::int32_t row = cell_of(p.y());
  const FloorBlock block{block_of(column), block_of(row)};
  const auto at = tile_with(tiles, island_of[point.patch.index()], block, point.patch);
  if (at == tiles.end()) return std::nullopt;
  return FloorPlace{static_cast<std::uint32_t>(at - tiles.begin()), column - block.column * kBlockCells,
                    row - block.row * kBlockCells};
}

Vector2d FloorPlan::centre(const FloorPlace& place) const {
  const FloorBlock& block = tiles[place.tile]->block;
  return kFloorCell *
         Vector2d(block.column * kBlockCells + place.column + 0.5, block.row * kBlockCells + place.row + 0.5);
}

FloorPlan make_floor_plan(const Map& map, const Neighbours& neighbours, const NavigationOptions& options,
                          const FloorPlan* before) {
  FloorPlan plan;
  plan.options = options;
  plan.T_plane_patch.assign(map.poses().begin(), map.poses().end());
  for (std::size_t i = 0; i < map.patch_count(); ++i) plan.island_of.push_back(map.island_of(make_id<PatchId>(i)));
  if (before != nullptr) {
    plan.footsteps = before->footsteps;
    plan.bystanders = before->bystanders;
  }
  plan.footsteps.read(map);
  plan.bystanders.read(map);
  raster_patches(plan, map, before);
  std::vector<FloorTile> tiles = group_patches(plan, with_ways(map, neighbours));
  put_footsteps(plan, tiles);
  for (FloorTile& tile : tiles) {
    std::shared_ptr<const FloorTile> old = before != nullptr ? same_tile(*before, tile) : nullptr;
    if (old == nullptr) {
      lay_floor(tile, options);
      old = std::make_shared<const FloorTile>(std::move(tile));
    }
    plan.tiles.push_back(std::move(old));
  }
  join_tiles(plan);
  return plan;
}

}  // namespace helicoid
