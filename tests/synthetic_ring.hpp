// A corridor that leads back to where it began, for tests of what lies over what.
#pragma once

#include <algorithm>
#include <cmath>

#include "helicoid/manifold/neighbours.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid::synthetic {

/// All patches vouch for one another, or those do that were made less than `apart` after one another.
inline Neighbours neighbours_of(const Map& map, std::size_t apart = 1000) {
  Neighbours neighbours(map.patch_count());
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    for (std::size_t j = 0; j < neighbours.size(); ++j) {
      if (i != j && std::max(i, j) - std::min(i, j) < apart) neighbours[i].push_back(make_id<PatchId>(j));
    }
  }
  return neighbours;
}

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
