#include "helicoid/geometry/ray_casting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace helicoid {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Bounds the memory of a grid over a world that is spread wide.
constexpr double kMostCellsASide = 500;

/// From the point of a segment that is nearest to p.
Vector2d offset_from(const Vector2d& p, const Segment& s) {
  const Vector2d along = s.to - s.from;
  const double square = along.squaredNorm();
  const double at = square > 0 ? std::clamp((p - s.from).dot(along) / square, 0.0, 1.0) : 0;
  return p - s.from - at * along;
}

double point_distance(const Vector2d& p, const Segment& s) {
  return offset_from(p, s).norm();
}

/// Where along a ray it enters and leaves the box from the origin to `extent`; enter > leave if it misses.
struct Crossing {
  double enter, leave;
};
Crossing crossing(const Vector2d& from, const Vector2d& direction, const Vector2d& extent, double reach) {
  Crossing c{0, reach};
  for (int axis = 0; axis < 2; ++axis) {
    if (direction[axis] == 0) {
      if (from[axis] < 0 || from[axis] > extent[axis]) return {kInfinity, 0};
      continue;
    }
    const double a = -from[axis] / direction[axis];
    const double b = (extent[axis] - from[axis]) / direction[axis];
    c.enter = std::max(c.enter, std::min(a, b));
    c.leave = std::min(c.leave, std::max(a, b));
  }
  return c;
}

}  // namespace

double intersect(const Vector2d& origin, const Vector2d& direction, const Segment& segment) {
  const Vector2d along = segment.to - segment.from;
  const double cross = direction.x() * along.y() - direction.y() * along.x();
  if (cross == 0) return kInfinity;
  const Vector2d offset = segment.from - origin;
  const double t = (offset.x() * along.y() - offset.y() * along.x()) / cross;
  const double u = (offset.x() * direction.y() - offset.y() * direction.x()) / cross;
  return t >= 0 && u >= 0 && u <= 1 ? t : kInfinity;
}

Vector2d nearest_point(const Vector2d& point, const Segment& segment) {
  return point - offset_from(point, segment);
}

RayCaster::RayCaster(std::span<const Segment> segments, double cell)
    : segments_(segments.begin(), segments.end()), cell_(cell) {
  if (!segments_.empty()) lay_grid();
  sort_into_cells();
}

void RayCaster::lay_grid() {
  Vector2d low = segments_.front().from;
  Vector2d high = low;
  for (const Segment& s : segments_) {
    low = low.cwiseMin(s.from).cwiseMin(s.to);
    high = high.cwiseMax(s.from).cwiseMax(s.to);
  }
  cell_ = std::max(cell_, (high - low).maxCoeff() / kMostCellsASide);
  origin_ = low - Vector2d::Constant(0.5 * cell_);
  columns_ = static_cast<int>((high.x() - origin_.x()) / cell_) + 2;
  rows_ = static_cast<int>((high.y() - origin_.y()) / cell_) + 2;
}

void RayCaster::sort_into_cells() {
  // Every cell that the segment's bounding box touches and that lies near the segment itself.
  std::vector<std::vector<int>> cells(static_cast<std::size_t>(columns_) * rows_);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    const Vector2d a = (s.from.cwiseMin(s.to) - origin_) / cell_;
    const Vector2d b = (s.from.cwiseMax(s.to) - origin_) / cell_;
    for (int row = static_cast<int>(a.y()); row <= static_cast<int>(b.y()); ++row) {
      for (int column = static_cast<int>(a.x()); column <= static_cast<int>(b.x()); ++column) {
        const Vector2d centre = origin_ + cell_ * Vector2d(column + 0.5, row + 0.5);
        if (point_distance(centre, s) <= 0.7072 * cell_) {
          cells[static_cast<std::size_t>(row) * columns_ + column].push_back(static_cast<int>(i));
        }
      }
    }
  }
  start_.push_back(0);
  for (const auto& list : cells) {
    items_.insert(items_.end(), list.begin(), list.end());
    start_.push_back(static_cast<int>(items_.size()));
  }
}

std::span<const int> RayCaster::in_cell(int column, int row) const {
  const std::size_t cell = static_cast<std::size_t>(row) * columns_ + column;
  return {items_.data() + start_[cell], static_cast<std::size_t>(start_[cell + 1] - start_[cell])};
}

RayCaster::Hit RayCaster::cast(const Vector2d& origin, const Vector2d& direction, double reach) const {
  Hit hit{kInfinity, -1};
  if (segments_.empty()) return hit;
  const auto [enter, leave] = crossing(origin - origin_, direction, Vector2d(columns_ * cell_, rows_ * cell_), reach);
  if (enter > leave) return hit;
  const Vector2d at = (origin + enter * direction - origin_) / cell_;
  int cell[2] = {std::clamp(static_cast<int>(at.x()), 0, columns_ - 1),
                 std::clamp(static_cast<int>(at.y()), 0, rows_ - 1)};
  const int count[2] = {columns_, rows_};
  int step[2] = {0, 0};
  double next[2] = {kInfinity, kInfinity};
  double delta[2] = {kInfinity, kInfinity};
  for (int axis = 0; axis < 2; ++axis) {
    if (direction[axis] == 0) continue;
    step[axis] = direction[axis] > 0 ? 1 : -1;
    const double border = origin_[axis] + cell_ * (cell[axis] + (step[axis] > 0 ? 1 : 0));
    next[axis] = (border - origin[axis]) / direction[axis];
    delta[axis] = cell_ / std::abs(direction[axis]);
  }
  double here = enter;
  while (here <= leave && here <= hit.distance) {
    for (const int i : in_cell(cell[0], cell[1])) {
      const double distance = intersect(origin, direction, segments_[i]);
      if (distance < hit.distance && distance <= reach) hit = {distance, i};
    }
    const int axis = next[0] < next[1] ? 0 : 1;
    here = next[axis];
    next[axis] += delta[axis];
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] >= count[axis]) break;
  }
  return hit;
}

RayCaster::Hit RayCaster::nearest(const Vector2d& point, double reach) const {
  Hit best{kInfinity, -1};
  const Vector2d low = (point - Vector2d::Constant(reach) - origin_) / cell_;
  const Vector2d high = (point + Vector2d::Constant(reach) - origin_) / cell_;
  for (int row = std::max(0, static_cast<int>(std::floor(low.y())));
       row <= std::min(rows_ - 1, static_cast<int>(high.y())); ++row) {
    for (int column = std::max(0, static_cast<int>(std::floor(low.x())));
         column <= std::min(columns_ - 1, static_cast<int>(high.x())); ++column) {
      for (const int i : in_cell(column, row)) {
        const double distance = point_distance(point, segments_[i]);
        if (distance < best.distance) best = {distance, i};
      }
    }
  }
  return best.distance <= reach ? best : Hit{kInfinity, -1};
}

}  // namespace helicoid
