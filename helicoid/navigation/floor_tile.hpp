// One sheet's floor on one block of the plane: where a robot can be, and how far from anything that it could touch.
#pragma once

#include <memory>
#include <vector>

#include "helicoid/navigation/navigation_options.hpp"
#include "helicoid/navigation/patch_raster.hpp"

namespace helicoid {

/// Patches over a block that chains of neighbours (neighbours.hpp) over that block join: they vouch for one another's
/// floor, others do not.
struct FloorTile {
  IslandId island;
  FloorBlock block;
  std::vector<PatchId> patches;                             ///< ascending
  std::vector<std::shared_ptr<const PatchRaster>> rasters;  ///< theirs
  std::vector<Vector2d> footsteps;                          ///< where robots stood, from the halo's corner, metres
  TileBits free{};
  /// To the nearest obstacle, or to the nearest cell that is not known to be free (and the margin beyond), whichever is
  /// less; the least that is driven through where a robot has stood; 0 where nothing is known. Centimetres from the
  /// cell's centre, up to 80, row by row, halo included.
  std::vector<std::uint8_t> clearance;

  [[nodiscard]] double clearance_at(int tile_column, int tile_row) const {
    return 0.01 * clearance[tile_index(tile_column, tile_row)];
  }
  /// Between cells' centres, bilinear; `p` in metres from the halo's corner, at least half a cell within the halo.
  [[nodiscard]] double clearance_between(const Vector2d& p) const;
};

/// The clearance without which a place is not driven through, with room for what the raster rounds.
[[nodiscard]] int least_clearance_cm(const NavigationOptions& options);

/// Fills in what follows from patches, rasters and footsteps.
void lay_floor(FloorTile& tile, const NavigationOptions& options);

}  // namespace helicoid
