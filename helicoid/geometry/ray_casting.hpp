// Rays against line segments, through a grid of cells (Amanatides and Woo 1987).
#pragma once

#include <span>
#include <vector>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

struct Segment {
  Vector2d from, to;  ///< metres
};

/// The smallest distance along a ray at which it meets a segment, or infinity. `direction` is a unit vector.
[[nodiscard]] double intersect(const Vector2d& origin, const Vector2d& direction, const Segment& segment);

/// The point of a segment that is nearest to another one.
[[nodiscard]] Vector2d nearest_point(const Vector2d& point, const Segment& segment);

/// Segments sorted into square cells; immutable. Coordinates are finite.
class RayCaster {
 public:
  /// Cells of `cell` metres, or larger where the segments spread so far that there would be too many.
  explicit RayCaster(std::span<const Segment> segments, double cell = 1.0);

  struct Hit {
    double distance = 0;  ///< metres; infinity if nothing within reach
    int segment = -1;
  };
  /// The first segment that a ray meets within `reach` metres.
  [[nodiscard]] Hit cast(const Vector2d& origin, const Vector2d& direction, double reach) const;
  /// The segment nearest to a point, looked for within `reach`.
  [[nodiscard]] Hit nearest(const Vector2d& point, double reach) const;
  /// The smallest distance from a point to any segment, looked for within `reach`; infinity if none is that near.
  [[nodiscard]] double clearance(const Vector2d& point, double reach) const { return nearest(point, reach).distance; }
  [[nodiscard]] std::span<const Segment> segments() const { return segments_; }

 private:
  void lay_grid();
  void sort_into_cells();
  [[nodiscard]] std::span<const int> in_cell(int column, int row) const;
  std::vector<Segment> segments_;
  double cell_;
  Vector2d origin_ = Vector2d::Zero();
  int columns_ = 1, rows_ = 1;
  std::vector<int> start_;  ///< by cell, one more than cells
  std::vector<int> items_;  ///< segments, cell by cell
};

}  // namespace helicoid
