#include "helicoid/eval/map_quality.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kNearCell = 0.10;                        // a wall with an occupied cell so near is mapped, metres
constexpr double kGates[] = {1.0, 0.6, 0.35, 0.2, 0.15};  // of pairs, metres
constexpr double kMostly = 0.25;                          // where most walls are found, metres
constexpr int kMostIterations = 25;                       // at each gate
constexpr double kStill = 1e-4;                           // a step that changes nothing, metres or radians
constexpr std::size_t kFewest = 30;                       // occupied cells that can be aligned

/// The normal equations of one step of T_world_plane, in the world's frame about the chart's own middle.
struct StepEquations {
  Matrix3d information = Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
  std::size_t pairs = 0;
};

StepEquations pair_up(std::span<const Vector2d> p_plane, const RayCaster& walls, const Pose2& T_world_plane,
                      const Vector2d& middle, double gate) {
  StepEquations equations;
  for (const Vector2d& p : p_plane) {
    const Vector2d p_world = T_world_plane * p;
    RayCaster::Hit hit = walls.nearest(p_world, std::min(gate, kMostly));
    if (hit.segment < 0) hit = walls.nearest(p_world, gate);
    if (hit.segment < 0) continue;
    const Segment& wall = walls.segments()[static_cast<std::size_t>(hit.segment)];
    const Vector2d along = (wall.to - wall.from).normalized();
    const Vector2d offset = p_world - nearest_point(p_world, wall);
    // Beyond a wall's end the offset itself is the direction; on the wall its normal, however small the offset.
    const Vector2d across(-along.y(), along.x());
    const bool beside = std::abs(offset.dot(along)) < 1e-9;
    const Vector2d direction = beside ? across : Vector2d(offset / hit.distance);
    const Vector2d arm = p_world - middle;
    const Vector3d jacobian(direction.x(), direction.y(), arm.x() * direction.y() - arm.y() * direction.x());
    // Tukey's biweight: people, ghosts and walls that were missed pull at nothing.
    const double share = 1 - hit.distance * hit.distance / (gate * gate);
    equations.information += share * share * jacobian * jacobian.transpose();
    equations.gradient += share * share * offset.dot(direction) * jacobian;
    ++equations.pairs;
  }
  return equations;
}

/// All occupied cells, for looking up whether one is near.
class OccupiedPlaces {
 public:
  explicit OccupiedPlaces(std::vector<Vector2d> p_world) : points_(std::move(p_world)) {
    std::sort(points_.begin(), points_.end(), [](const Vector2d& a, const Vector2d& b) { return a.x() < b.x(); });
  }

  [[nodiscard]] bool is_near(const Vector2d& p) const {
    const auto before = [](const Vector2d& point, double x) { return point.x() < x; };
    auto it = std::lower_bound(points_.begin(), points_.end(), p.x() - kNearCell, before);
    for (; it != points_.end() && it->x() <= p.x() + kNearCell; ++it) {
      if ((*it - p).squaredNorm() <= kNearCell * kNearCell) return true;
    }
    return false;
  }

 private:
  std::vector<Vector2d> points_;  ///< in order of x
};

std::vector<Vector2d> occupied_cells(const MappedChart& chart) {
  std::vector<Vector2d> p_plane;
  for (std::size_t i = 0; i < chart.cells.size(); ++i) {
    if (chart.cells[i] == MappedCell::occupied) p_plane.push_back(chart.centre(i));
  }
  return p_plane;
}

double nearest_wall(const RayCaster& walls, const Vector2d& p_world) {
  for (double reach = 0.25; reach < 1e4; reach *= 4) {
    const double distance = walls.clearance(p_world, reach);
    if (std::isfinite(distance)) return distance;
  }
  return 0;
}

double root_mean_square_gap(const RayCaster& walls, std::span<const Vector2d> p_world) {
  double squares = 0;
  for (const Vector2d& p : p_world) squares += std::pow(nearest_wall(walls, p), 2);
  return p_world.empty() ? 0 : std::sqrt(squares / static_cast<double>(p_world.size()));
}

double recall(std::span<const Segment> seen_walls, const OccupiedPlaces& occupied) {
  double all = 0;
  double found = 0;
  for (const Segment& piece : seen_walls) {
    const double length = (piece.to - piece.from).norm();
    all += length;
    if (occupied.is_near(0.5 * (piece.from + piece.to))) found += length;
  }
  return all > 0 ? found / all : 0;
}

}  // namespace

Vector2d MappedChart::centre(std::size_t index) const {
  const std::size_t column = index % static_cast<std::size_t>(width);
  const std::size_t row = index / static_cast<std::size_t>(width);
  return origin + cell * Vector2d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
}

MappedCell MappedChart::at(const Vector2d& p_plane) const {
  const Vector2d at = (p_plane - origin) / cell;
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() < width && at.y() < height)) return MappedCell::unknown;
  return cells[static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(width) + static_cast<std::size_t>(at.x())];
}

WallAlignment align_with_walls(std::span<const Vector2d> p_plane, const RayCaster& walls, const Pose2& T_world_plane) {
  WallAlignment alignment{T_world_plane, false, 0};
  if (p_plane.size() < kFewest || walls.segments().empty()) return alignment;
  Vector2d sum = Vector2d::Zero();
  for (const Vector2d& p : p_plane) sum += p;
  const Vector2d middle_plane = sum / static_cast<double>(p_plane.size());
  for (const double gate : kGates) {
    alignment.converged = false;
    for (int k = 0; k < kMostIterations && !alignment.converged; ++k) {
      const Vector2d middle = alignment.T_world_plane * middle_plane;
      const StepEquations e = pair_up(p_plane, walls, alignment.T_world_plane, middle, gate);
      if (e.pairs < kFewest) return {alignment.T_world_plane, false, alignment.iterations};
      const Vector3d step = -(e.information + 1e-9 * Matrix3d::Identity()).ldlt().solve(e.gradient);
      const Pose2 T_middle_moved{step.x(), step.y(), step.z()};
      const Pose2 T_world_middle{middle.x(), middle.y(), 0};
      alignment.T_world_plane = T_world_middle * T_middle_moved * T_world_middle.inverse() * alignment.T_world_plane;
      alignment.converged = step.cwiseAbs().maxCoeff() < kStill;
      ++alignment.iterations;
    }
  }
  return alignment;
}

MapQuality map_quality(std::span<const MappedChart> charts, const TrueBuilding& building) {
  MapQuality quality;
  const RayCaster seen_walls(building.seen_walls, kMostly);
  std::vector<Vector2d> occupied;  // in the world
  for (const MappedChart& chart : charts) {
    const std::vector<Vector2d> p_plane = occupied_cells(chart);
    const WallAlignment alignment = align_with_walls(p_plane, seen_walls, chart.T_world_plane);
    quality.T_world_plane.push_back(alignment.T_world_plane);
    quality.aligned.push_back(alignment.converged);
    for (const Vector2d& p : p_plane) occupied.push_back(alignment.T_world_plane * p);
  }
  std::size_t mapped = 0;
  for (const Vector2d& p_world : building.reachable) {
    bool known = false;
    for (std::size_t i = 0; i < charts.size() && !known; ++i) {
      known = charts[i].at(quality.T_world_plane[i].inverse() * p_world) != MappedCell::unknown;
    }
    if (known) ++mapped;
  }
  const double area = building.reachable_cell * building.reachable_cell;
  quality.reachable_m2 = area * static_cast<double>(building.reachable.size());
  quality.mapped_m2 = area * static_cast<double>(mapped);
  quality.mapped_fraction = quality.reachable_m2 > 0 ? quality.mapped_m2 / quality.reachable_m2 : 0;
  quality.wall_rms_m = root_mean_square_gap(RayCaster(building.walls), occupied);
  quality.wall_recall = recall(building.seen_walls, OccupiedPlaces(std::move(occupied)));
  return quality;
}

}  // namespace helicoid
