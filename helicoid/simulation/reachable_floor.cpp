#include "helicoid/simulation/reachable_floor.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace helicoid {

namespace {

constexpr double kEnough = 0.5;  // room that need not be known better; metres
constexpr double kLook = 1.2;    // how far walls are looked for at once: cells around then need no look; metres
constexpr double kFine = 0.01;   // where a robot's centre fits into a cell is found to this, metres

/// The flood of cells in which a robot's centre can be, from the starts.
class Flood {
 public:
  Flood(const RayCaster& walls, ReachableFloor floor, const FloorOptions& options)
      : walls_(walls), floor_(std::move(floor)), options_(options), state_(floor_.room.size(), kUnknown) {}

  bool begin_at(const Vector2d& start) {
    const std::size_t cell = floor_.cell_at(start);
    if (cell >= state_.size() || walls_.clearance(start, options_.radius) < options_.radius) return false;
    if (state_[cell] != kIn) enter(cell, static_cast<float>(options_.radius));
    return true;
  }

  ReachableFloor run() {
    const auto width = static_cast<std::size_t>(floor_.width);
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const std::size_t cell = cells_[k];
      const std::size_t column = cell % width;
      if (column == 0 || column + 1 == width || cell < width || cell + width >= state_.size()) {
        floor_.enclosed = false;
        continue;
      }
      for (const std::size_t next : {cell - 1, cell + 1, cell - width, cell + width}) {
        if (state_[next] == kUnknown) look_at(next, floor_.room[cell]);
      }
    }
    return std::move(floor_);
  }

 private:
  static constexpr std::uint8_t kUnknown = 0, kIn = 1, kOut = 2;

  void enter(std::size_t cell, float room) {
    state_[cell] = kIn;
    floor_.room[cell] = room;
    cells_.push_back(cell);
  }

  /// `beside`: the room at a neighbour; a step changes it by no more than its length.
  void look_at(std::size_t cell, float beside) {
    const double at_least = static_cast<double>(beside) - floor_.cell;
    if (at_least >= kEnough) return enter(cell, static_cast<float>(at_least));
    const Vector2d centre = floor_.centre(cell);
    const double room = std::min(walls_.clearance(centre, kLook), kLook);
    if (room >= options_.radius || fits_beside(centre, room)) return enter(cell, static_cast<float>(room));
    state_[cell] = kOut;
  }

  /// Whether the robot's centre fits elsewhere into the cell: openings little wider than the robot may lie between the
  /// raster's centres.
  bool fits_beside(const Vector2d& centre, double room) const {
    const double half = 0.5 * floor_.cell;
    if (room + std::numbers::sqrt2 * half < options_.radius) return false;
    const int steps = std::max(1, static_cast<int>(half / kFine));
    for (int row = -steps; row <= steps; ++row) {
      for (int column = -steps; column <= steps; ++column) {
        const Vector2d at = centre + half / steps * Vector2d(column, row);
        if (walls_.clearance(at, options_.radius) >= options_.radius) return true;
      }
    }
    return false;
  }

  const RayCaster& walls_;
  ReachableFloor floor_;
  FloorOptions options_;
  std::vector<std::uint8_t> state_;
  std::vector<std::size_t> cells_;
};

/// A raster over all walls and starts, and a little beyond.
Result<ReachableFloor> lay_raster(const World& world, std::span<const Pose2> starts, const FloorOptions& options) {
  Vector2d low = starts.front().translation();
  Vector2d high = low;
  const auto take_in = [&](const Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (const Segment& s : world.walls) {
    take_in(s.from);
    take_in(s.to);
  }
  for (const Pose2& start : starts) take_in(start.translation());
  const Vector2d margin = Vector2d::Constant(2 * options.radius + 3 * options.cell);
  const Vector2d cells = (high - low + 2 * margin) / options.cell;
  if (!(cells.x() * cells.y() < static_cast<double>(options.most_cells))) {
    return fail("{}: is too large to find its floor on a raster of {} m ({:.0f} x {:.0f} m)", world.name, options.cell,
                high.x() - low.x(), high.y() - low.y());
  }
  ReachableFloor floor;
  floor.origin = low - margin;
  floor.cell = options.cell;
  floor.width = static_cast<int>(std::ceil(cells.x()));
  floor.height = static_cast<int>(std::ceil(cells.y()));
  floor.room.assign(static_cast<std::size_t>(floor.width) * static_cast<std::size_t>(floor.height), 0.0F);
  return floor;
}

/// What robots cover. No wall is nearer to a centre than its room, and a robot that is there covers all within it; that
/// of the centres nearest to walls holds all that the floor has more than its centres.
void sweep(ReachableFloor& floor, double radius) {
  floor.swept.assign(floor.room.size(), 0);
  for (std::size_t cell = 0; cell < floor.room.size(); ++cell) {
    const auto room = static_cast<double>(floor.room[cell]);
    if (room <= 0) continue;
    floor.swept[cell] = 1;
    if (room > radius + 2 * floor.cell) continue;
    const auto reach = static_cast<int>(room / floor.cell);
    const auto column = static_cast<int>(cell % static_cast<std::size_t>(floor.width));
    const auto row = static_cast<int>(cell / static_cast<std::size_t>(floor.width));
    for (int r = std::max(0, row - reach); r <= std::min(floor.height - 1, row + reach); ++r) {
      for (int c = std::max(0, column - reach); c <= std::min(floor.width - 1, column + reach); ++c) {
        if (floor.cell * std::hypot(r - row, c - column) > room) continue;
        floor.swept[static_cast<std::size_t>(r) * static_cast<std::size_t>(floor.width) + static_cast<std::size_t>(c)] =
            1;
      }
    }
  }
}

}  // namespace

double ReachableFloor::area() const {
  return cell * cell * static_cast<double>(std::accumulate(swept.begin(), swept.end(), std::size_t{0}));
}

std::vector<Vector2d> ReachableFloor::swept_centres() const {
  std::vector<Vector2d> centres;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    if (swept[i] != 0) centres.push_back(centre(i));
  }
  return centres;
}

Vector2d ReachableFloor::centre(std::size_t cell_index) const {
  const std::size_t column = cell_index % static_cast<std::size_t>(width);
  const std::size_t row = cell_index / static_cast<std::size_t>(width);
  return origin + cell * Vector2d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
}

std::size_t ReachableFloor::cell_at(const Vector2d& point) const {
  const Vector2d at = (point - origin) / cell;
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() < width && at.y() < height)) return room.size();
  return static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(width) + static_cast<std::size_t>(at.x());
}

bool ReachableFloor::holds_robot(const Vector2d& point) const {
  const std::size_t index = cell_at(point);
  return index < room.size() && room[index] > 0;
}

Result<ReachableFloor> find_reachable_floor(const World& world, std::span<const Pose2> starts,
                                            const FloorOptions& options) {
  if (starts.empty()) return fail("{}: no start from which the floor could be reached", world.name);
  Result<ReachableFloor> raster = lay_raster(world, starts, options);
  if (!raster) return raster;
  const RayCaster walls(world.walls);
  Flood flood(walls, std::move(*raster), options);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (flood.begin_at(starts[i].translation())) continue;
    return fail("{}: start {} at ({:.2f}, {:.2f}) is nearer to a wall than the robot's radius of {:.2f} m", world.name,
                i + 1, starts[i].x, starts[i].y, options.radius);
  }
  ReachableFloor floor = flood.run();
  sweep(floor, options.radius);
  return floor;
}

}  // namespace helicoid
