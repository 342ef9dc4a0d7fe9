// Where robots stood: floor that is known to carry a robot, seen or not.
#pragma once

#include <vector>

#include "helicoid/navigation/manifold_point.hpp"
#include "helicoid/navigation/trajectory_reader.hpp"

namespace helicoid {

class Footsteps {
 public:
  /// Takes in what the trajectories have grown by. Trajectories that are not the ones from before are read anew.
  void read(const Map& map);
  /// A point every few centimetres of each robot's way, robot by robot.
  [[nodiscard]] const std::vector<ManifoldPoint>& points() const { return points_; }

 private:
  /// The last that was kept of a robot.
  struct Step {
    PatchId patch;
    Vector2d p_plane = Vector2d::Zero();
  };

  TrajectoryReader reader_;
  std::vector<Step> steps_;  ///< by robot
  std::vector<ManifoldPoint> points_;
};

}  // namespace helicoid
