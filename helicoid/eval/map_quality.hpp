// A map against the building that it is of: how much of the floor, how true the walls, how many of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/geometry/ray_casting.hpp"

namespace helicoid {

enum class MappedCell : std::uint8_t { unknown, free, occupied };

/// A planar chart of one island: square cells, row by row, and about where its plane lies in the world.
struct MappedChart {
  Vector2d origin = Vector2d::Zero();  ///< p_plane of the first cell's corner, metres
  double cell = 0.05;                  ///< metres
  int width = 0, height = 0;
  std::vector<MappedCell> cells;
  Pose2 T_world_plane;  ///< a first guess: good to a metre and some degrees

  [[nodiscard]] Vector2d centre(std::size_t index) const;  ///< p_plane
  [[nodiscard]] MappedCell at(const Vector2d& p_plane) const;
};

struct TrueBuilding {
  std::span<const Segment> walls;       ///< all of them
  std::span<const Segment> seen_walls;  ///< the pieces of wall that can be seen from the reachable floor; short ones
  std::span<const Vector2d> reachable;  ///< the centres of the reachable floor's cells
  double reachable_cell = 0.05;         ///< their side, metres
};

struct MapQuality {
  double reachable_m2 = 0;
  double mapped_m2 = 0;              ///< of the reachable floor: what some chart knows
  double mapped_fraction = 0;        ///< of it
  double wall_rms_m = 0;             ///< from all occupied cells to the nearest wall
  double wall_recall = 0;            ///< the share of the wall that can be seen with an occupied cell within 10 cm
  std::vector<Pose2> T_world_plane;  ///< by chart, after its one rigid alignment
  std::vector<bool> aligned;         ///< by chart: false if it holds too little, or the alignment did not come to rest
};

/// Aligns each chart's occupied cells rigidly with the walls that can be seen (point to line, robustly), then measures.
[[nodiscard]] MapQuality map_quality(std::span<const MappedChart> charts, const TrueBuilding& building);

/// The rigid alignment by itself: from a first guess, iterated with a gate that narrows.
struct WallAlignment {
  Pose2 T_world_plane;
  bool converged = false;
  int iterations = 0;
};
[[nodiscard]] WallAlignment align_with_walls(std::span<const Vector2d> p_plane, const RayCaster& walls,
                                             const Pose2& T_world_plane);

}  // namespace helicoid
