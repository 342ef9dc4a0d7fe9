// What a robot could ever cover of a building.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/simulation/world.hpp"

namespace helicoid {

struct FloorOptions {
  double radius = 0.20;                 ///< of the robot, metres
  double cell = 0.05;                   ///< of the raster, metres
  std::size_t most_cells = 80'000'000;  ///< of the raster over the whole world; larger worlds are refused
};

/// The floor swept by a disc of the robot's radius on all its ways from its starts, as a raster of square cells.
struct ReachableFloor {
  Vector2d origin = Vector2d::Zero();  ///< the corner of the first cell, metres
  double cell = 0.05;                  ///< metres
  int width = 0, height = 0;
  std::vector<float> room;          ///< where a robot's centre can be: at least so far from walls, metres; elsewhere 0
  std::vector<std::uint8_t> swept;  ///< 1 where a robot can cover the cell
  bool enclosed = true;             ///< false: it leads out of the world, and ends where the raster does

  /// The swept area, m^2.
  [[nodiscard]] double area() const;
  [[nodiscard]] std::vector<Vector2d> swept_centres() const;
  [[nodiscard]] Vector2d centre(std::size_t cell_index) const;
  /// The index of the cell that holds a point; room.size() outside of the raster.
  [[nodiscard]] std::size_t cell_at(const Vector2d& point) const;
  /// Whether a robot's centre can be in the cell that holds this point.
  [[nodiscard]] bool holds_robot(const Vector2d& point) const;
};

/// Errors: no start where a robot fits, a world too large for the raster.
[[nodiscard]] Result<ReachableFloor> find_reachable_floor(const World& world, std::span<const Pose2> starts,
                                                          const FloorOptions& options = {});

}  // namespace helicoid
