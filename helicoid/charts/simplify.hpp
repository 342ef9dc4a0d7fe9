// Lines with fewer points.
#pragma once

#include <span>
#include <vector>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid::charts {

/// Douglas and Peucker (1973): leaves out points that lie within `tolerance` of what remains; keeps both ends. Units
/// are those of the points.
[[nodiscard]] std::vector<Vector2d> simplify(std::span<const Vector2d> line, double tolerance);

}  // namespace helicoid::charts
