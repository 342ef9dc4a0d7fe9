// The raster on which routes are planned: square blocks of an island's plane. On each block there are as many tiles
// (floor_tile.hpp) as sheets lie over it.
#pragma once

#include <array>
#include <cstdint>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

constexpr double kFloorCell = 0.10;  ///< metres
/// Cells along the edge of a block.
constexpr int kBlockCells = 48;
/// A tile knows this many cells beyond its block, so that it can tell clearances by itself.
constexpr int kHaloCells = 8;
constexpr int kTileCells = kBlockCells + 2 * kHaloCells;
/// Clearances are told up to here, metres.
constexpr double kMostClearance = kHaloCells * kFloorCell;

/// A bit a cell, halo included: row by row, bit c of word r.
using TileBits = std::array<std::uint64_t, kTileCells>;
static_assert(kTileCells == 64);

/// Where a tile keeps what it knows of a cell; column and row count from the halo's corner.
[[nodiscard]] constexpr std::size_t tile_index(int column, int row) {
  return static_cast<std::size_t>(row) * kTileCells + static_cast<std::size_t>(column);
}
/// Where what lies in direction (dc, dr) is kept, each -1..1.
[[nodiscard]] constexpr std::size_t direction_index(int dc, int dr) {
  const int index = 3 * dr + dc + 4;
  return static_cast<std::size_t>(index);
}

/// Which block: block (c, r) begins at cell (48 c, 48 r) of the plane.
struct FloorBlock {
  std::int32_t column = 0;
  std::int32_t row = 0;
  friend auto operator<=>(const FloorBlock&, const FloorBlock&) = default;

  /// The plane's coordinates of the lower left corner of the block's halo, metres.
  [[nodiscard]] Vector2d halo_corner() const {
    return kFloorCell * Vector2d(column * kBlockCells - kHaloCells, row * kBlockCells - kHaloCells);
  }
};

[[nodiscard]] constexpr std::int32_t floor_divide(std::int32_t a, std::int32_t b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}
/// The block in which a cell lies, along one axis.
[[nodiscard]] constexpr std::int32_t block_of(std::int32_t cell) {
  return floor_divide(cell, kBlockCells);
}
/// The first and the last block that know a cell, halos included, along one axis.
[[nodiscard]] constexpr std::int32_t first_block_about(std::int32_t cell) {
  return block_of(cell - kBlockCells - kHaloCells) + 1;
}
[[nodiscard]] constexpr std::int32_t last_block_about(std::int32_t cell) {
  return block_of(cell + kHaloCells);
}
[[nodiscard]] inline std::int32_t cell_of(double metres) {
  return static_cast<std::int32_t>(std::floor(metres / kFloorCell));
}

}  // namespace helicoid
