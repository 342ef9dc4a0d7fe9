#include "helicoid/simulation/seen_walls.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// The raster's cells to which some way leads from the floor, be it as thin as a ray: nothing else can be seen.
std::vector<std::uint8_t> find_connected(const RayCaster& walls, const ReachableFloor& floor) {
  std::vector<std::uint8_t> connected = floor.swept;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < connected.size(); ++i) {
    if (connected[i] != 0) open.push_back(i);
  }
  const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    const Vector2d here = floor.centre(cell);
    for (const auto& step : steps) {
      const Vector2d direction(step[0], step[1]);
      const std::size_t next = floor.cell_at(here + floor.cell * direction);
      if (next >= connected.size() || connected[next] != 0) continue;
      if (walls.cast(here, direction, floor.cell).segment >= 0) continue;
      connected[next] = 1;
      open.push_back(next);
    }
  }
  return connected;
}

/// Whether a point sees the centre of a connected cell that is its own or next to that.
bool is_connected(const RayCaster& walls, const ReachableFloor& floor, const std::vector<std::uint8_t>& connected,
                  const Vector2d& at) {
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const std::size_t cell = floor.cell_at(at + floor.cell * Vector2d(column, row));
      if (cell >= connected.size() || connected[cell] == 0) continue;
      const Vector2d way = floor.centre(cell) - at;
      if (way.norm() == 0 || walls.cast(at, way.normalized(), way.norm()).segment < 0) return true;
    }
  }
  return false;
}

/// Whether a laser at some place on the floor lies on this ray, up to where the ray meets a wall.
bool leads_to_robot(const RayCaster& walls, const ReachableFloor& floor, const Vector2d& from,
                    const Vector2d& direction, double reach) {
  const double end = std::min(walls.cast(from, direction, reach).distance, reach);
  const double step = 0.5 * floor.cell;
  for (double at = step; at < end; at += step) {
    const std::size_t cell = floor.cell_at(from + at * direction);
    if (cell >= floor.room.size()) return false;
    if (floor.room[cell] > 0) return true;
  }
  return false;
}

/// Looks at a piece of wall from straight ahead first: that is where robots mostly are.
bool is_seen(const RayCaster& walls, const ReachableFloor& floor, const std::vector<std::uint8_t>& connected,
             const Vector2d& at, const Vector2d& along, const SeenWallOptions& options) {
  constexpr double kClear = 1e-4;  // from the wall itself, metres
  const double steepest = 0.5 * std::numbers::pi - options.flattest;
  const double straight = std::atan2(along.x(), -along.y());
  for (const double side : {0.0, std::numbers::pi}) {
    const Vector2d ahead(std::cos(straight + side), std::sin(straight + side));
    if (!is_connected(walls, floor, connected, at + kClear * ahead)) continue;
    for (int k = 0; k * options.direction_step <= steepest; ++k) {
      for (const double turn : {k * options.direction_step, -k * options.direction_step}) {
        const double angle = straight + side + turn;
        const Vector2d direction(std::cos(angle), std::sin(angle));
        if (leads_to_robot(walls, floor, at + kClear * direction, direction, options.reach)) return true;
        if (k == 0) break;
      }
    }
  }
  return false;
}

}  // namespace

std::vector<Segment> find_seen_walls(const World& world, const ReachableFloor& floor, const SeenWallOptions& options) {
  const RayCaster walls(world.walls);
  const std::vector<std::uint8_t> connected = find_connected(walls, floor);
  std::vector<Segment> seen;
  for (const Segment& wall : world.walls) {
    const Vector2d along = wall.to - wall.from;
    const int pieces = static_cast<int>(std::ceil(along.norm() / options.piece));
    for (int k = 0; k < pieces; ++k) {
      const auto at = [&](double share) -> Vector2d { return wall.from + (k + share) / pieces * along; };
      if (is_seen(walls, floor, connected, at(0.5), along, options)) seen.push_back({at(0), at(1)});
    }
  }
  return seen;
}

}  // namespace helicoid
