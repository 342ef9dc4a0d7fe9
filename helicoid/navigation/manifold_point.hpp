// A place on the manifold: a point in the frame of a patch, which stays the same place whatever a fit does to the map.
#pragma once

#include "helicoid/manifold/map.hpp"

namespace helicoid {

struct ManifoldPoint {
  PatchId patch;
  Vector2d p_patch = Vector2d::Zero();  ///< metres
  friend bool operator==(const ManifoldPoint&, const ManifoldPoint&) = default;
};

/// A way to look.
struct ManifoldHeading {
  PatchId patch;
  double heading_patch = 0;  ///< radians
};

[[nodiscard]] inline ManifoldPoint point_of(const ManifoldPose& pose) {
  return {pose.patch, pose.T_patch_robot.translation()};
}

/// Where a point of the manifold projects to in its island's plane.
[[nodiscard]] inline Vector2d project(const Map& map, const ManifoldPoint& point) {
  return map.T_plane_patch(point.patch) * point.p_patch;
}

}  // namespace helicoid
