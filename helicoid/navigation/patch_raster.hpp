// What one patch says of the floor, block by block: made once, and again only when the patch has moved in the plane.
#pragma once

#include <span>
#include <vector>

#include "helicoid/manifold/patch.hpp"
#include "helicoid/navigation/floor_block.hpp"

namespace helicoid {

struct PatchRaster {
  struct Part {
    FloorBlock block;
    TileBits free{};                         ///< cells whose centres lie in the patch's free space
    TileBits surely_free{};                  ///< cells well within it and near the laser, where it overlooks nothing
    std::vector<Eigen::Vector2f> obstacles;  ///< metres from the halo's lower left corner
  };
  RobotId robot;
  std::size_t scan_index = 0;
  Pose2 T_plane_patch;
  std::vector<Vector2d> bystanders;  ///< robots that stood about when the patch was made; metres, the patch's frame
  std::vector<Part> parts;           ///< of the blocks (halos included) where the patch has free cells; ascending
  [[nodiscard]] const Part* part(const FloorBlock& block) const;
  /// True if it is of this patch where that stands there, to a centimetre at the rim of what it sees, and of no other
  /// bystanders.
  [[nodiscard]] bool holds(const Patch& patch, const Pose2& T_plane_patch_now,
                           std::span<const Vector2d> bystanders_now) const;
};

/// What bystanders returned is no obstacle.
[[nodiscard]] PatchRaster make_patch_raster(const Patch& patch, const Pose2& T_plane_patch,
                                            std::vector<Vector2d> bystanders);

}  // namespace helicoid
