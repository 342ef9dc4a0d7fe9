// A way over cells pulled taut.
#pragma once

#include <span>
#include <vector>

#include "helicoid/navigation/floor_plan.hpp"

namespace helicoid {

/// A corner of a taut way.
struct WayPoint {
  std::uint32_t tile = 0;
  Vector2d p_plane = Vector2d::Zero();
};

/// A way over cells from and to points (plane) in its first and last.
struct CellWay {
  Vector2d from = Vector2d::Zero(), to = Vector2d::Zero();
  std::vector<FloorPlace> places;
};

/// Corners of the way between which the straight line keeps the clearance that the way had there, as far as that is
/// sought; its ends included, corners at most `spacing` metres apart.
[[nodiscard]] std::vector<WayPoint> pull_taut(const FloorPlan& plan, const CellWay& way,
                                              const std::vector<bool>& closed, double spacing);

}  // namespace helicoid
