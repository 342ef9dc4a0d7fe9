// The occupancy grid: for each cell, how many patches saw a surface in it and how many saw through it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/charts/grid_frame.hpp"

namespace helicoid {

/// What one patch's view of a cell adds to its log-odds (Moravec and Elfes 1985), and ROS's thresholds.
struct OccupancyModel {
  double hit = 4.0;              ///< a surface in the cell: a wall is one if a quarter of the views say so
  double miss = -1.5;            ///< free space over the cell: one is enough to call it free
  double occupied_above = 0.65;  ///< probability
  double free_below = 0.196;     ///< probability
};

enum class CellState : std::uint8_t { unknown, free, occupied };

/// Counts rather than sums, so that the order in which patches are drawn cannot show.
struct OccupancyGrid {
  GridFrame frame;
  std::vector<std::uint16_t> hits;    ///< patches with a surface in the cell
  std::vector<std::uint16_t> misses;  ///< patches whose free space holds the cell's centre
  OccupancyModel model;

  [[nodiscard]] double log_odds(std::size_t cell) const { return model.hit * hits[cell] + model.miss * misses[cell]; }
  [[nodiscard]] bool seen(std::size_t cell) const { return hits[cell] != 0 || misses[cell] != 0; }
  /// 0.5 where nothing was seen.
  [[nodiscard]] double probability(std::size_t cell) const;
};

/// Draws these patches (an island's, or a sheet's). Surfaces are drawn as the cells that the line between neighbouring
/// points of one surface runs through; free space as the cells whose centre lies in the patch's free-space polygon,
/// drawn in by half a cell; a patch says nothing about cells beside its
/// own surfaces, so that grazing views and noise do not wear walls away (such a cell counts as
/// missed once if no patch says more). The same bytes for any number of threads.
[[nodiscard]] OccupancyGrid draw_occupancy(const Map& map, std::span<const PatchId> patches, const GridFrame& frame,
                                           int threads = 1, const OccupancyModel& model = {});

/// Free, occupied or unknown for every cell.
[[nodiscard]] std::vector<CellState> classify(const OccupancyGrid& grid);

}  // namespace helicoid
