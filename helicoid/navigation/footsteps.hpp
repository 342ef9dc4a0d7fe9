// Where robots stood: floor that is known to carry a robot, seen or not.
#pragma once

#include <vector>

#include "helicoid/navigation/manifold_point.hpp"

namespace helicoid {

class Footsteps {
 public:
  /// Takes in what the trajectories have grown by. Trajectories that are not the ones from before are read anew.
  void read(const Map& map);
  /// A point every few centimetres of each robot's way, robot by robot.
  [[nodiscard]] const std::vector<ManifoldPoint>& points() const { return points_; }

 private:
  /// Up to where a robot's trajectory was read.
  struct Reader {
    std::size_t scans = 0;
    TrackedScan last;
    Vector2d p_plane = Vector2d::Zero();  ///< of the last step that was kept
    PatchId patch;
  };
  [[nodiscard]] bool follows(const Map& map) const;

  std::vector<Reader> readers_;
  std::vector<ManifoldPoint> points_;
};

}  // namespace helicoid
