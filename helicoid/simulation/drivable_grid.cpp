#include "helicoid/simulation/drivable_grid.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// A space of cells that hang together.
struct Space {
  std::vector<std::size_t> cells;
  bool open = false;  ///< it reaches the raster's edge: it is outside
};

Space flood(const DrivableGrid& grid, std::size_t from, std::vector<std::uint8_t>& seen) {
  Space space;
  space.cells.push_back(from);
  seen[from] = 1;
  for (std::size_t k = 0; k < space.cells.size(); ++k) {
    const auto column = static_cast<int>(space.cells[k] % static_cast<std::size_t>(grid.width));
    const auto row = static_cast<int>(space.cells[k] / static_cast<std::size_t>(grid.width));
    if (column == 0 || row == 0 || column + 1 == grid.width || row + 1 == grid.height) space.open = true;
    constexpr int kSteps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (const auto& step : kSteps) {
      const int c = column + step[0];
      const int r = row + step[1];
      if (!grid.drivable(c, r) || seen[grid.index(c, r)] != 0) continue;
      seen[grid.index(c, r)] = 1;
      space.cells.push_back(grid.index(c, r));
    }
  }
  return space;
}

Space largest_closed_space(const DrivableGrid& grid) {
  std::vector<std::uint8_t> seen(grid.clearance.size(), 0);
  Space best;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] != 0 || grid.clearance[i] <= 0) continue;
    Space space = flood(grid, i, seen);
    if (!space.open && space.cells.size() > best.cells.size()) best = std::move(space);
  }
  return best;
}

Space space_around(const DrivableGrid& grid, const Vector2d& start) {
  // The nearest drivable cell within a metre: a start may stand close to a wall.
  std::size_t nearest = 0;
  double best = 1;
  for (std::size_t i = 0; i < grid.clearance.size(); ++i) {
    const double distance = (grid.centre(i) - start).norm();
    if (grid.clearance[i] <= 0 || distance >= best) continue;
    best = distance;
    nearest = i;
  }
  if (best >= 1) return {};
  std::vector<std::uint8_t> seen(grid.clearance.size(), 0);
  return flood(grid, nearest, seen);
}

}  // namespace

Result<DrivableGrid> make_drivable_grid(const World& world, double cell, double clearance, double farthest,
                                        std::size_t most_cells) {
  Vector2d low = world.walls.front().from;
  Vector2d high = low;
  for (const Segment& s : world.walls) {
    low = low.cwiseMin(s.from).cwiseMin(s.to);
    high = high.cwiseMax(s.from).cwiseMax(s.to);
  }
  DrivableGrid grid;
  grid.cell = cell;
  grid.origin = low - Vector2d::Constant(3 * cell + clearance);
  const Vector2d extent = (high - low) / cell + Vector2d::Constant(6 + 2 * clearance / cell);
  if (extent.x() * extent.y() > static_cast<double>(most_cells)) {
    return fail("{}: is too large to plan a tour on ({:.0f} x {:.0f} m); give it a route", world.name,
                high.x() - low.x(), high.y() - low.y());
  }
  grid.width = static_cast<int>(std::ceil(extent.x()));
  grid.height = static_cast<int>(std::ceil(extent.y()));
  grid.clearance.resize(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  const RayCaster walls(world.walls);
  for (std::size_t i = 0; i < grid.clearance.size(); ++i) {
    const double room = std::min(walls.clearance(grid.centre(i), farthest), farthest);
    grid.clearance[i] = room >= clearance ? static_cast<float>(room) : 0.0F;
  }
  const Space space =
      world.starts.empty() ? largest_closed_space(grid) : space_around(grid, world.starts[0].translation());
  std::vector<float> reachable(grid.clearance.size(), 0.0F);
  for (const std::size_t i : space.cells) reachable[i] = grid.clearance[i];
  grid.clearance = std::move(reachable);
  return grid;
}

}  // namespace helicoid
