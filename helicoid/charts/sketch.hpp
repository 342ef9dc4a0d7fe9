// The sketch map: free space as polygons with holes, walls and frontiers as lines.
#pragma once

#include <vector>

#include "helicoid/charts/occupancy_grid.hpp"

namespace helicoid {

/// What bounds free space.
enum class Border : std::uint8_t {
  wall,      ///< a surface was seen there
  frontier,  ///< nothing is known beyond: the edge of what was explored
};

/// A closed ring: outer ones run anticlockwise, holes clockwise; free space is on the left.
struct SketchRing {
  std::vector<Vector2d> points;  ///< plane, metres; the last is joined to the first
  std::vector<Border> borders;   ///< borders[i] lies between points[i] and the next
};

struct Sketch {
  std::vector<SketchRing> rings;
  int dropped_specks = 0;  ///< pieces of free space smaller than smallest_piece
  int filled_holes = 0;    ///< unknown holes without a surface in them, smaller than smallest_hole
};

struct SketchOptions {
  double tolerance = 0.025;         ///< how far a line may leave the raster's contour, metres
  double smallest_piece = 0.10;     ///< square metres
  double smallest_hole = 0.03;      ///< square metres
  double shortest_frontier = 0.25;  ///< a shorter one between walls is drawn as wall, metres
};

/// The contour of the grid's free cells (marching squares: Lorensen and Cline 1987 in two dimensions), simplified.
/// Diagonal neighbours are not joined, so that thin walls stay closed.
[[nodiscard]] Sketch make_sketch(const OccupancyGrid& grid, const SketchOptions& options = {});

/// Of the free space, holes taken off; square metres.
[[nodiscard]] double area(const Sketch& sketch);

}  // namespace helicoid
