#include "helicoid/exploration/look.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

namespace helicoid {

namespace {

/// Cells along a side of a SeenSquare.
constexpr std::int32_t kSquare = 4;
static_assert(kSquare * kGroundCell > kSeenSquare - 1e-9 && kSquare * kGroundCell < kSeenSquare + 1e-9);

std::int32_t square_of(std::int32_t cell) {
  return (cell >= 0 ? cell : cell - kSquare + 1) / kSquare;
}

/// Distance of each cell to the nearest obstacle, cells, by two sweeps with the weights of an octagon.
std::vector<double> obstacle_distance(const GroundWindow& window) {
  const int width = window.width();
  std::vector<double> distance(window.cells(), 1e9);
  const auto at = [&](int row, int column) -> double& {
    return distance[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  };
  const auto relax = [&](int row, int column, int r, int c, double step) {
    if (r < 0 || c < 0 || r >= width || c >= width) return;
    at(row, column) = std::min(at(row, column), at(r, c) + step);
  };
  for (int row = 0; row < width; ++row) {
    for (int column = 0; column < width; ++column) {
      if (window.is_obstacle({window.low().row + row, window.low().column + column})) at(row, column) = 0;
    }
  }
  for (const int d : {-1, 1}) {
    for (int k = 0; k < width; ++k) {
      const int row = d < 0 ? k : width - 1 - k;
      for (int m = 0; m < width; ++m) {
        const int column = d < 0 ? m : width - 1 - m;
        relax(row, column, row, column + d, 1);
        relax(row, column, row + d, column, 1);
        relax(row, column, row + d, column + d, std::sqrt(2.0));
        relax(row, column, row + d, column - d, std::sqrt(2.0));
      }
    }
  }
  return distance;
}

}  // namespace

Look look_from(const GroundWindow& window, const Vector2d& p_plane, double heading_plane, double field_of_view,
               double range) {
  // Rays as far apart as cells at half the range: nearly every cell is met, and cells near by many times.
  const int rays = static_cast<int>(std::ceil(field_of_view * 0.7 * range / kGroundCell));
  std::vector<std::uint8_t> met(window.cells(), 0);
  std::map<std::pair<std::int32_t, std::int32_t>, int> squares;
  int cells = 0;
  for (int k = 0; k < rays; ++k) {
    const double angle = heading_plane + field_of_view * ((k + 0.5) / rays - 0.5);
    const Vector2d step = kGroundCell * Vector2d(std::cos(angle), std::sin(angle));
    Vector2d p = p_plane;
    for (int n = 0; n < static_cast<int>(range / kGroundCell); ++n, p += step) {
      const GroundCell cell = ground_cell(p);
      if (!window.holds(cell) || window.is_near_obstacle(cell)) break;
      if (!window.is_unknown(cell) || met[window.index(cell)] != 0) continue;
      met[window.index(cell)] = 1;
      ++cells;
      ++squares[{square_of(cell.row), square_of(cell.column)}];
    }
  }
  Look look;
  look.gain_m2 = cells * kGroundCell * kGroundCell;
  for (const auto& [square, count] : squares) {
    look.seen.push_back({square.first, square.second, count * kGroundCell * kGroundCell});
  }
  return look;
}

double widest_opening(const GroundWindow& window, std::span<const GroundCell> from, std::span<const GroundCell> to) {
  const std::vector<double> distance = obstacle_distance(window);
  std::vector<double> width(window.cells(), -1);
  std::vector<std::uint8_t> wanted(window.cells(), 0);
  for (const GroundCell& c : to) {
    if (window.holds(c)) wanted[window.index(c)] = 1;
  }
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry> open;
  const auto push = [&](const GroundCell& c, double least) {
    if (!window.holds(c) || !window.is_free(c)) return;
    const std::size_t i = window.index(c);
    const double here = std::min(least, distance[i]);
    if (here <= width[i]) return;
    width[i] = here;
    open.emplace(here, i);
  };
  // Edges end at obstacles: what counts is the way, not where it begins.
  for (const GroundCell& c : from) push(c, 1e9);
  while (!open.empty()) {
    const auto [least, i] = open.top();
    open.pop();
    if (least < width[i]) continue;
    // An obstacle's cell is half a cell wide about its wall.
    if (wanted[i] != 0) return std::max(0.0, 2 * least - 1) * kGroundCell;
    const auto row = window.low().row + static_cast<std::int32_t>(i) / window.width();
    const auto column = window.low().column + static_cast<std::int32_t>(i) % window.width();
    for (std::int32_t r = -1; r <= 1; ++r) {
      for (std::int32_t c = -1; c <= 1; ++c) push({row + r, column + c}, least);
    }
  }
  return 0;
}

}  // namespace helicoid
