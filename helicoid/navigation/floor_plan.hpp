// All floor that a map knows: the tiles of every sheet of every island and how they join.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "helicoid/manifold/neighbours.hpp"
#include "helicoid/navigation/bystanders.hpp"
#include "helicoid/navigation/floor_tile.hpp"
#include "helicoid/navigation/footsteps.hpp"

namespace helicoid {

/// A cell of the floor on its sheet.
struct FloorPlace {
  std::uint32_t tile = 0;
  std::int32_t column = 0;  ///< within the block, 0..47
  std::int32_t row = 0;
  friend bool operator==(const FloorPlace&, const FloorPlace&) = default;
};

constexpr std::uint32_t kPlacesOfTile = kBlockCells * kBlockCells;

/// Places are numbered tile by tile, row by row.
[[nodiscard]] constexpr std::uint32_t number_of(const FloorPlace& place) {
  return place.tile * kPlacesOfTile + static_cast<std::uint32_t>(place.row * kBlockCells + place.column);
}
[[nodiscard]] constexpr FloorPlace place_of(std::uint32_t number) {
  const auto within = static_cast<std::int32_t>(number % kPlacesOfTile);
  return {number / kPlacesOfTile, within % kBlockCells, within / kBlockCells};
}

struct FloorPlan {
  NavigationOptions options;
  std::vector<Pose2> T_plane_patch;  ///< by patch
  std::vector<IslandId> island_of;   ///< by patch
  std::vector<std::shared_ptr<const PatchRaster>> rasters;
  Footsteps footsteps;
  Bystanders bystanders;
  std::vector<std::shared_ptr<const FloorTile>> tiles;  ///< ascending by island and block
  /// By tile, by direction_index: the tiles on the blocks beside it that share a patch with it, and with
  /// that its sheet.
  std::vector<std::array<std::vector<std::uint32_t>, 9>> beside;

  [[nodiscard]] std::size_t place_count() const { return tiles.size() * kPlacesOfTile; }
  /// The place on the patch's own sheet; none where the patch and its neighbours know no floor.
  [[nodiscard]] std::optional<FloorPlace> locate(const ManifoldPoint& point) const;
  /// The plane's coordinates of a place's centre.
  [[nodiscard]] Vector2d centre(const FloorPlace& place) const;
  /// Centimetres.
  [[nodiscard]] int clearance_cm(const FloorPlace& place) const {
    return tiles[place.tile]->clearance[tile_index(place.column + kHaloCells, place.row + kHaloCells)];
  }
  /// Calls f(place) for the places next to this one in direction (dc, dr), each -1..1: several where sheets part.
  template <class F>
  void for_each_next(const FloorPlace& from, int dc, int dr, F&& f) const {
    FloorPlace to{from.tile, from.column + dc, from.row + dr};
    const int bc = to.column < 0 ? -1 : to.column >= kBlockCells ? 1 : 0;
    const int br = to.row < 0 ? -1 : to.row >= kBlockCells ? 1 : 0;
    if (bc == 0 && br == 0) {
      f(to);
      return;
    }
    to.column -= bc * kBlockCells;
    to.row -= br * kBlockCells;
    for (const std::uint32_t tile : beside[from.tile][direction_index(bc, br)]) {
      to.tile = tile;
      f(to);
    }
  }
};

/// What holds of the plan before (of the same map, some time ago) is taken over.
[[nodiscard]] FloorPlan make_floor_plan(const Map& map, const Neighbours& neighbours, const NavigationOptions& options,
                                        const FloorPlan* before);

}  // namespace helicoid
