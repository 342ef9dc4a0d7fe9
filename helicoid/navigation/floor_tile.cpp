#include "helicoid/navigation/floor_tile.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

namespace helicoid {

namespace {

/// A robot that stood somewhere swept this much floor, and a little for the raster; metres.
constexpr double kFootstep = 0.30;
/// Cells whose centre lies this near to where a robot's was: that which holds it is among them; metres.
constexpr double kSameStand = 0.75 * kFloorCell;
/// Walls are known to so many centimetres, raster included. What stands nearer by more than that has come since.
constexpr int kForgiven = 5;

using SquaredDistances = std::array<float, kTileCells * kTileCells>;

bool has(const TileBits& bits, int column, int row) {
  return (bits[static_cast<std::size_t>(row)] >> static_cast<unsigned>(column) & 1U) != 0;
}

/// Calls f(column, row, squared distance) for the cells of the tile whose centres lie within `radius` of p.
template <class F>
void for_each_cell_near(const Vector2d& p, double radius, F&& f) {
  const auto low = [&](double at) {
    return std::max(0, static_cast<int>(std::ceil((at - radius) / kFloorCell - 0.5)));
  };
  const auto high = [&](double at) {
    return std::min(kTileCells - 1, static_cast<int>(std::floor((at + radius) / kFloorCell - 0.5)));
  };
  const int first = low(p.x());
  const int last = high(p.x());
  for (int row = low(p.y()); row <= high(p.y()); ++row) {
    const auto dy = static_cast<float>((row + 0.5) * kFloorCell - p.y());
    for (int column = first; column <= last; ++column) {
      const auto dx = static_cast<float>((column + 0.5) * kFloorCell - p.x());
      f(column, row, dx * dx + dy * dy);
    }
  }
}

/// Cells in which patches see an obstacle, and how many do.
struct Hits {
  TileBits any{};
  std::array<std::uint16_t, kTileCells * kTileCells> count{};
};

std::size_t cell_index(const Eigen::Vector2f& p) {
  const int column = std::clamp(static_cast<int>(p.x() / static_cast<float>(kFloorCell)), 0, kTileCells - 1);
  const int row = std::clamp(static_cast<int>(p.y() / static_cast<float>(kFloorCell)), 0, kTileCells - 1);
  return tile_index(column, row);
}

Hits count_hits(std::span<const PatchRaster::Part* const> parts) {
  Hits hits;
  for (const PatchRaster::Part* part : parts) {
    TileBits own{};
    for (const Eigen::Vector2f& p : part->obstacles) {
      const std::size_t cell = cell_index(p);
      const std::uint64_t bit = std::uint64_t{1} << (cell % kTileCells);
      if ((own[cell / kTileCells] & bit) != 0) continue;
      own[cell / kTileCells] |= bit;
      ++hits.count[cell];
    }
    for (std::size_t row = 0; row < own.size(); ++row) hits.any[row] |= own[row];
  }
  return hits;
}

/// Cells in which more patches look right through what others saw: it has gone (a person, a robot, a door).
TileBits gone(std::span<const PatchRaster::Part* const> parts, const Hits& hits) {
  TileBits doubtful{};
  for (const PatchRaster::Part* part : parts) {
    for (std::size_t row = 0; row < doubtful.size(); ++row) doubtful[row] |= part->surely_free[row] & hits.any[row];
  }
  TileBits result{};
  for (std::size_t row = 0; row < doubtful.size(); ++row) {
    for (std::uint64_t rest = doubtful[row]; rest != 0; rest &= rest - 1) {
      const auto column = static_cast<unsigned>(std::countr_zero(rest));
      int through = 0;
      for (const PatchRaster::Part* part : parts) through += static_cast<int>(part->surely_free[row] >> column & 1U);
      if (through > hits.count[row * kTileCells + column]) result[row] |= std::uint64_t{1} << column;
    }
  }
  return result;
}

void lower(SquaredDistances& distances, const Vector2d& p, double radius) {
  for_each_cell_near(p, radius, [&](int column, int row, float squared) {
    float& at = distances[tile_index(column, row)];
    at = std::min(at, squared);
  });
}

/// Every obstacle counts where it decides whether a robot may pass; farther off one a cell will do.
void keep_from_obstacles(std::span<const PatchRaster::Part* const> parts, double decisive,
                         SquaredDistances& distances) {
  const Hits hits = count_hits(parts);
  const TileBits no_more = gone(parts, hits);
  TileBits told{};
  for (const PatchRaster::Part* part : parts) {
    for (const Eigen::Vector2f& p : part->obstacles) {
      const std::size_t cell = cell_index(p);
      const std::uint64_t bit = std::uint64_t{1} << (cell % kTileCells);
      if ((no_more[cell / kTileCells] & bit) != 0) continue;
      const bool is_first = (told[cell / kTileCells] & bit) == 0;
      told[cell / kTileCells] |= bit;
      lower(distances, p.cast<double>(), is_first ? kMostClearance : decisive);
    }
  }
}

/// What is not known to be free, where it borders on what is.
void keep_from_the_unknown(const TileBits& free, double margin, SquaredDistances& distances) {
  for (int row = 0; row < kTileCells; ++row) {
    const auto r = static_cast<std::size_t>(row);
    std::uint64_t beside = free[r] << 1U | free[r] >> 1U;
    if (row > 0) beside |= free[r - 1];
    if (row + 1 < kTileCells) beside |= free[r + 1];
    for (std::uint64_t rest = beside & ~free[r]; rest != 0; rest &= rest - 1) {
      const Vector2d centre = kFloorCell * Vector2d(std::countr_zero(rest) + 0.5, row + 0.5);
      for_each_cell_near(centre, kMostClearance, [&](int column, int cell_row, float squared) {
        float& at = distances[tile_index(column, cell_row)];
        if (squared >= at) return;
        const float moved = std::sqrt(squared) + static_cast<float>(margin);
        at = std::min(at, moved * moved);
      });
    }
  }
}

}  // namespace

double FloorTile::clearance_between(const Vector2d& p) const {
  const double x = p.x() / kFloorCell - 0.5;
  const double y = p.y() / kFloorCell - 0.5;
  const int column = std::clamp(static_cast<int>(std::floor(x)), 0, kTileCells - 2);
  const int row = std::clamp(static_cast<int>(std::floor(y)), 0, kTileCells - 2);
  const double right = std::clamp(x - column, 0.0, 1.0);
  const double up = std::clamp(y - row, 0.0, 1.0);
  return (1 - up) * ((1 - right) * clearance_at(column, row) + right * clearance_at(column + 1, row)) +
         up * ((1 - right) * clearance_at(column, row + 1) + right * clearance_at(column + 1, row + 1));
}

int least_clearance_cm(const NavigationOptions& options) {
  // A line between two cells that have it comes a centimetre nearer to an obstacle than either centre.
  return static_cast<int>(std::ceil(100 * options.least_clearance() - 1e-6)) + 1;
}

void lay_floor(FloorTile& tile, const NavigationOptions& options) {
  std::vector<const PatchRaster::Part*> parts;
  for (const auto& raster : tile.rasters) parts.push_back(raster->part(tile.block));
  for (const PatchRaster::Part* part : parts) {
    for (std::size_t row = 0; row < tile.free.size(); ++row) tile.free[row] |= part->free[row];
  }
  for (const Vector2d& step : tile.footsteps) {
    for_each_cell_near(step, kFootstep, [&](int column, int row, float) {
      tile.free[static_cast<std::size_t>(row)] |= std::uint64_t{1} << static_cast<unsigned>(column);
    });
  }
  SquaredDistances distances;
  distances.fill(static_cast<float>(kMostClearance * kMostClearance));
  keep_from_obstacles(parts, options.least_clearance() + kFloorCell, distances);
  keep_from_the_unknown(tile.free, options.margin, distances);
  tile.clearance.assign(distances.size(), 0);
  for (int row = 0; row < kTileCells; ++row) {
    for (int column = 0; column < kTileCells; ++column) {
      if (!has(tile.free, column, row)) continue;
      const auto cell = tile_index(column, row);
      tile.clearance[cell] = static_cast<std::uint8_t>(100 * std::sqrt(distances[cell]) + 1e-3F);
    }
  }
  // There was room for a robot wherever one stood.
  const auto least = static_cast<std::uint8_t>(least_clearance_cm(options));
  for (const Vector2d& step : tile.footsteps) {
    for_each_cell_near(step, kSameStand, [&](int column, int row, float) {
      std::uint8_t& at = tile.clearance[tile_index(column, row)];
      if (at + kForgiven >= least) at = std::max(at, least);
    });
  }
}

}  // namespace helicoid
