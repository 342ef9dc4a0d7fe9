#include "helicoid/charts/raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "helicoid/charts/palette.hpp"

namespace helicoid::charts {

namespace {

/// A wall of one cell is smoothed to half its height at most, a slanting one to less: its edge lies below that.
constexpr int kWallEdge = 86;

/// What is interpolated, by cell, 0..255, with a border of one cell all round.
struct Field {
  int width = 0;
  std::vector<std::uint8_t> known, wall, overlap;
};

/// The field averaged over 3 x 3 cells with weights 1 2 1: what makes slanting walls straight rather than stairs.
void smooth(std::vector<std::uint8_t>& values, std::size_t width) {
  const std::vector<std::uint8_t> sharp = values;
  const std::uint8_t* v = sharp.data();
  for (std::size_t cell = width + 1; cell + width + 1 < values.size(); ++cell) {
    const std::uint8_t* at = v + cell;
    const std::uint8_t* up = at + width;
    const std::uint8_t* down = at - width;
    const int sum = 4 * at[0] + 2 * (at[-1] + at[1] + up[0] + down[0]) + up[-1] + up[1] + down[-1] + down[1];
    values[cell] = static_cast<std::uint8_t>(sum / 16);
  }
}

Field make_field(const SheetStack& sheets) {
  const GridFrame& frame = sheets.grid.frame;
  const std::vector<CellState> states = classify(sheets.grid);
  Field field{frame.width + 2, {}, {}, {}};
  const std::size_t size = static_cast<std::size_t>(frame.width + 2) * static_cast<std::size_t>(frame.height + 2);
  field.known.resize(size);
  field.wall.resize(size);
  field.overlap.resize(size);
  for (int row = 0; row < frame.height; ++row) {
    for (int column = 0; column < frame.width; ++column) {
      const std::size_t cell = frame.index(column, row);
      const std::size_t to = static_cast<std::size_t>(row + 1) * static_cast<std::size_t>(field.width) + column + 1;
      // What was seen but not decided lies along walls: floor, so that no rim of ground shows there.
      field.known[to] = sheets.grid.seen(cell) ? 255 : 0;
      field.wall[to] = states[cell] == CellState::occupied ? 255 : 0;
      field.overlap[to] = sheets.depth[cell] > 1 ? 255 : 0;
    }
  }
  smooth(field.known, static_cast<std::size_t>(field.width));
  smooth(field.wall, static_cast<std::size_t>(field.width));
  return field;
}

/// 0..256 as `value` 0..255 rises through one half, over a width that is about one pixel at this scale.
std::array<int, 256> make_edge(int scale, int middle) {
  std::array<int, 256> edge{};
  const double width = std::clamp(160.0 / scale, 40.0, 110.0);
  for (int value = 0; value < 256; ++value) {
    const double at = std::clamp((value - middle) / width + 0.5, 0.0, 1.0);
    edge[static_cast<std::size_t>(value)] = static_cast<int>(std::lround(256 * at * at * (3 - 2 * at)));
  }
  return edge;
}

std::uint32_t blend(std::uint32_t under, Colour over, int share) {
  std::uint32_t mixed = 0;
  for (const unsigned shift : {0U, 8U, 16U}) {
    const int value = (channel(under, shift) * (256 - share) + channel(over, shift) * share) >> 8;
    mixed |= static_cast<std::uint32_t>(value) << shift;
  }
  return mixed;
}

/// One pixel's place between four cell centres, in parts of 256.
struct Between {
  int cell = 0;
  int share = 0;
};
std::vector<Between> places(int cells, int scale) {
  std::vector<Between> all(static_cast<std::size_t>(cells) * static_cast<std::size_t>(scale));
  for (std::size_t i = 0; i < all.size(); ++i) {
    // The border shifts cell centres from k + 0.5 to k + 1.5.
    const double at = (static_cast<double>(i) + 0.5) / scale + 0.5;
    all[i].cell = static_cast<int>(at);
    all[i].share = static_cast<int>((at - all[i].cell) * 256);
  }
  return all;
}

class Painter {
 public:
  Painter(const Field& field, int scale)
      : field_(field), scale_(scale), floor_edge_(make_edge(scale, 128)), wall_edge_(make_edge(scale, kWallEdge)) {}

  void paint_row(const std::vector<Between>& columns, const Between& row, int y, std::uint32_t* pixels) const {
    const std::size_t below = static_cast<std::size_t>(row.cell) * static_cast<std::size_t>(field_.width);
    for (std::size_t x = 0; x < columns.size(); ++x) {
      const std::size_t cell = below + static_cast<std::size_t>(columns[x].cell);
      pixels[x] = colour(cell, columns[x].share, row.share, static_cast<int>(x), y);
    }
  }

 private:
  [[nodiscard]] int mix(const std::vector<std::uint8_t>& values, std::size_t cell, int right, int up) const {
    const std::uint8_t* low = values.data() + cell;
    const std::uint8_t* high = low + field_.width;
    if (low[0] == low[1] && low[0] == high[0] && low[0] == high[1]) return low[0];
    const int bottom = low[0] * (256 - right) + low[1] * right;
    const int top = high[0] * (256 - right) + high[1] * right;
    return (bottom * (256 - up) + top * up) >> 16;
  }

  [[nodiscard]] std::uint32_t colour(std::size_t cell, int right, int up, int x, int y) const {
    const int floor = floor_edge_[static_cast<std::size_t>(mix(field_.known, cell, right, up))];
    std::uint32_t pixel = floor == 0 ? kUnknown : floor == 256 ? kFree : blend(kUnknown, kFree, floor);
    const int overlap = mix(field_.overlap, cell, right, up);
    if (overlap > 127) {
      const int period = std::max(8, 4 * scale_);
      pixel = blend(pixel, kOverlap, (x + y) % period < period / 4 ? 130 : 40);
    }
    const int wall = wall_edge_[static_cast<std::size_t>(mix(field_.wall, cell, right, up))];
    return wall == 0 ? pixel : blend(pixel, kWall, wall);
  }

  const Field& field_;
  int scale_;
  std::array<int, 256> floor_edge_, wall_edge_;
};

}  // namespace

Raster paint(const SheetStack& sheets, int scale, const RasterMargins& margins) {
  const GridFrame& frame = sheets.grid.frame;
  const Field field = make_field(sheets);
  const int map_height = frame.height * scale;
  Raster raster;
  raster.width = std::max(frame.width * scale, margins.smallest_width);
  raster.height = map_height + margins.foot;
  raster.scale = scale;
  raster.left = (raster.width - frame.width * scale) / 2;
  raster.pixels.assign(static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height), kUnknown);
  const std::vector<Between> columns = places(frame.width, scale);
  const std::vector<Between> rows = places(frame.height, scale);
  const Painter painter(field, scale);
  for (int y = 0; y < map_height; ++y) {
    const Between& row = rows[static_cast<std::size_t>(map_height - 1 - y)];
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(raster.width);
    painter.paint_row(columns, row, y, raster.pixels.data() + first + raster.left);
  }
  return raster;
}

}  // namespace helicoid::charts
