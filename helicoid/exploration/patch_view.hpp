// What one patch says about a place: free, an obstacle, or nothing. For many places asked in a row.
#pragma once

#include <cstdint>
#include <vector>

#include "helicoid/manifold/patch.hpp"
#include "helicoid/sensor/beam_finder.hpp"

namespace helicoid {

/// A stretch of a patch's free-space boundary of which the laser says nothing more (design 5.7): neither an obstacle
/// nor known beyond.
struct OpenPoint {
  Eigen::Vector2f p_patch;        ///< on the boundary, metres
  Eigen::Vector2f outward_patch;  ///< unit vector into what is not known
};

/// Distances in metres.
struct PatchViewOptions {
  double obstacle_reach = 0.12;  ///< what lies this near to an obstacle is not open: walls are seen with noise
  double body = 0.25;            ///< about the robot's origin the floor is free: the robot stood there
  double spacing = 0.10;         ///< of the points on an open edge
};

/// Immutable, as its patch is; the patch outlives it.
class PatchView {
 public:
  explicit PatchView(const Patch& patch, const PatchViewOptions& options = {});

  /// True if the patch tells what is there: free floor, or an obstacle within reach of the point.
  [[nodiscard]] bool knows(const Vector2d& p_patch) const;
  /// The open edges of its free space: shadows, the laser's reach, the ends of its field of view.
  [[nodiscard]] const std::vector<OpenPoint>& open_points() const { return open_points_; }
  /// The obstacles: stretches between the ends of neighbouring beams (from == to: a single end that is certain).
  struct Surface {
    Eigen::Vector2f from_patch, to_patch;
  };
  [[nodiscard]] std::vector<Surface> surfaces() const;
  [[nodiscard]] const Patch& patch() const { return *patch_; }

 private:
  [[nodiscard]] bool near_obstacle(const Eigen::Vector2f& p_laser, std::ptrdiff_t beam) const;
  void find_open_points();
  void open_edge(const Eigen::Vector2f& from_patch, const Eigen::Vector2f& to_patch);
  [[nodiscard]] bool is_surface(std::size_t beam, std::size_t next) const;
  [[nodiscard]] std::size_t surface_end(std::size_t beam) const;
  [[nodiscard]] bool is_obstacle(std::size_t beam) const { return returned_[beam] != 0 && in_between_[beam] == 0; }
  void find_in_between();

  const Patch* patch_;
  PatchViewOptions options_;
  BeamFinder beams_;
  Eigen::Matrix2f R_laser_patch_;
  Eigen::Vector2f t_laser_patch_;
  std::vector<Eigen::Vector2f> ends_;   ///< of the beams, in the laser's frame
  std::vector<std::uint8_t> returned_;  ///< the beam ends on a surface
  /// It ends alone, between a nearer and a farther one: on a wall met at a grazing angle, or in the air, if the beam
  /// met two surfaces by halves. Which, only a nearer look tells: it is taken for neither.
  std::vector<std::uint8_t> in_between_;
  std::vector<OpenPoint> open_points_;
};

}  // namespace helicoid
