// The occupancy grid as pixels: smooth walls on smooth floors.
#pragma once

#include <cstdint>
#include <vector>

#include "helicoid/charts/sheet_charts.hpp"

namespace helicoid::charts {

/// Pixels 0x00RRGGBB, row 0 at the top.
struct Raster {
  int width = 0;
  int height = 0;  ///< the legend's strip at the foot included
  int scale = 1;   ///< pixels a cell
  int left = 0;    ///< the map's left edge
  std::vector<std::uint32_t> pixels;
};

/// Ground around the map, pixels.
struct RasterMargins {
  int smallest_width = 0;  ///< a narrower map stands in the middle
  int foot = 0;
};

/// Each cell becomes scale x scale pixels; between cell centres "free" and "wall" are interpolated and their edges
/// drawn soft over about one pixel. Cells that more than one sheet knows are hatched.
[[nodiscard]] Raster paint(const SheetStack& sheets, int scale, const RasterMargins& margins = {});

}  // namespace helicoid::charts
