// Maps of several buildings laid out in one plane, tied where one is entered from another.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// A map of one island, and where it goes.
struct PlacedMap {
  const Map* map = nullptr;
  std::string name;  ///< goes before its robots' names, with a "-"; in maps of one name they are the same
  Pose2 T_plane_map;
};

/// Patches of two maps whose relative pose is known, as they are laid out.
struct Passage {
  std::size_t map_a = 0, map_b = 0;
  PatchId a, b;                             ///< in their own maps
  Matrix3d information = Matrix3d::Zero();  ///< of (x, y, yaw) of T_a_b
};

/// All of them as one island, fitted or not as they were.
[[nodiscard]] Map lay_out(std::span<const PlacedMap> maps, std::span<const Passage> passages);

}  // namespace helicoid
