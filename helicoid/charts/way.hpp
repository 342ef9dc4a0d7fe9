// Where robots went, as lines for charts.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// One robot's way over some patches: a line for each run of scans that stand on them.
struct Way {
  RobotId robot;
  std::string name;
  std::vector<std::vector<Vector2d>> lines;  ///< in the island's plane, metres
};

/// The ways of all robots that have scans on these patches, by robot; points within `tolerance` [m] of the line between
/// others are left out.
[[nodiscard]] std::vector<Way> ways_over(const Map& map, std::span<const PatchId> patches, double tolerance = 0.01);

}  // namespace helicoid
