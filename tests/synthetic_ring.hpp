// A corridor that leads back to where it began, for tests of what lies over what.
#pragma once

#include <cmath>

#include "tests/synthetic_room.hpp"

namespace helicoid::synthetic {

/// A corridor of 2 m round a block, driven round a little more than once.
struct Ring {
  std::vector<Wall> walls = rectangle(0, 0, 20, 14);
  Builder builder;
  Ring() {
    append(walls, rectangle(2, 2, 18, 12));
    const std::vector<Vector2d> corners{{1, 1}, {19, 1}, {19, 13}, {1, 13}};
    for (double along = 0; along < 66; along += 1.5) {
      double rest = std::fmod(along, 60);
      std::size_t k = 0;
      for (; rest > (corners[(k + 1) % 4] - corners[k]).norm(); k = (k + 1) % 4) {
        rest -= (corners[(k + 1) % 4] - corners[k]).norm();
      }
      const Vector2d way = (corners[(k + 1) % 4] - corners[k]).normalized();
      const Vector2d p = corners[k] + rest * way;
      builder.add(walls, {p.x(), p.y(), wrap_angle(std::atan2(way.y(), way.x()))});
    }
  }
  [[nodiscard]] ManifoldPose last() const { return {make_id<PatchId>(builder.map.patch_count() - 1), {}}; }
};

}  // namespace helicoid::synthetic
