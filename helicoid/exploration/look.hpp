// What a look from a place would newly see, as far as one can tell beforehand.
#pragma once

#include <vector>

#include "helicoid/exploration/frontiers.hpp"

namespace helicoid {

/// The unknown floor that a fan of rays meets before an obstacle.
struct Look {
  double gain_m2 = 0;
  std::vector<SeenSquare> seen;  ///< ascending by row and column
};
/// `heading_plane` in radians; obstacles are marked in the window (mark_near_obstacles).
[[nodiscard]] Look look_from(const GroundWindow& window, const Vector2d& p_plane, double heading_plane,
                             double field_of_view, double range);

/// The width of the narrowest place on the widest way over known floor between two sets of cells, metres; 0: no way.
[[nodiscard]] double widest_opening(const GroundWindow& window, std::span<const GroundCell> from,
                                    std::span<const GroundCell> to);

}  // namespace helicoid
