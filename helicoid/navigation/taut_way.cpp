#include "helicoid/navigation/taut_way.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kSample = 0.04;  // metres
constexpr std::size_t kFailures = 12;

/// Follows a straight line over the tiles; where sheets part, onto the sheet of the way that it replaces.
class LineWalker {
 public:
  LineWalker(const FloorPlan& plan, const CellWay& way, const std::vector<bool>& closed)
      : plan_(plan), way_(way.places), closed_(closed) {
    for (const FloorPlace& place : way_) points_.push_back(plan.centre(place));
    points_.front() = way.from;
    points_.back() = way.to;
  }

  [[nodiscard]] WayPoint point(std::size_t i) const { return {way_[i].tile, points_[i]}; }

  /// The tile at whose floor the line from `way[i]` to `way[j]` ends, if all of it has the clearance; none else. Calls
  /// f(WayPoint) on the way.
  template <class F>
  bool walk(std::size_t i, std::size_t j, double clearance, F&& f) const {
    const Vector2d& from = points_[i];
    const Vector2d& to = points_[j];
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kSample)));
    std::uint32_t tile = way_[i].tile;
    for (int k = 0; k <= steps; ++k) {
      const Vector2d p = from + (to - from) * k / steps;
      const std::optional<FloorPlace> at = place_at(tile, p, i, j);
      if (!at || (!closed_.empty() && closed_[number_of(*at)])) return false;
      tile = at->tile;
      const FloorTile& floor = *plan_.tiles[tile];
      if (floor.clearance_between(p - floor.block.halo_corner()) < clearance) return false;
      f(WayPoint{tile, p});
    }
    return tile == way_[j].tile;
  }

 private:
  std::optional<FloorPlace> place_at(std::uint32_t tile, const Vector2d& p, std::size_t i, std::size_t j) const {
    const FloorBlock& block = plan_.tiles[tile]->block;
    FloorPlace at{tile, cell_of(p.x()) - block.column * kBlockCells, cell_of(p.y()) - block.row * kBlockCells};
    const int bc = block_of(at.column);
    const int br = block_of(at.row);
    if (bc == 0 && br == 0) return at;
    if (std::abs(bc) > 1 || std::abs(br) > 1) return std::nullopt;
    at.column -= bc * kBlockCells;
    at.row -= br * kBlockCells;
    const std::vector<std::uint32_t>& beside = plan_.beside[tile][direction_index(bc, br)];
    if (beside.empty()) return std::nullopt;
    at.tile = beside.front();
    for (std::size_t k = i; beside.size() > 1 && k <= j; ++k) {
      if (std::find(beside.begin(), beside.end(), way_[k].tile) == beside.end()) continue;
      at.tile = way_[k].tile;
      break;
    }
    return at;
  }

  const FloorPlan& plan_;
  std::span<const FloorPlace> way_;
  const std::vector<bool>& closed_;
  std::vector<Vector2d> points_;
};

}  // namespace

std::vector<WayPoint> pull_taut(const FloorPlan& plan, const CellWay& way, const std::vector<bool>& closed,
                                double spacing) {
  const LineWalker walker(plan, way, closed);
  const double comfortable = std::min(plan.options.comfortable, kMostClearance);
  // Told in centimetres, rounded down; and lines run between cells' centres.
  const auto required = [&](double least) { return std::max(least - 0.02, plan.options.least_clearance()); };
  const auto clearance = [&](std::size_t i) { return std::min(comfortable, 0.01 * plan.clearance_cm(way.places[i])); };
  std::vector<WayPoint> points{walker.point(0)};
  const std::size_t size = way.places.size();
  for (std::size_t i = 0; i + 1 < size;) {
    // As far as a straight line leads; a few failures in a row may be a matter of the raster.
    std::size_t farthest = i + 1;
    double least = std::min(clearance(i), clearance(i + 1));
    double least_there = least;
    for (std::size_t j = i + 2; j < std::min(size, farthest + kFailures); ++j) {
      least = std::min(least, clearance(j));
      if (!walker.walk(i, j, required(least), [](const WayPoint&) {})) continue;
      farthest = j;
      least_there = least;
    }
    const Vector2d from = points.back().p_plane;
    const double length = (walker.point(farthest).p_plane - from).norm();
    double next = spacing;
    if (farthest > i + 1 && length > spacing) {
      walker.walk(i, farthest, required(least_there), [&](const WayPoint& point) {
        if ((point.p_plane - from).norm() < next || length - next < 0.2 * spacing) return;
        points.push_back(point);
        next += spacing;
      });
    }
    points.push_back(walker.point(farthest));
    i = farthest;
  }
  if (size == 1) points.push_back({way.places.front().tile, way.to});
  return points;
}

}  // namespace helicoid
