// Robots that stood about while a patch was made: they are no part of the building, whether they were seen or not.
#pragma once

#include <vector>

#include "helicoid/navigation/manifold_point.hpp"

namespace helicoid {

class Bystanders {
 public:
  /// Takes in patches that are new. A map that is not the one from before is read anew.
  void read(const Map& map);
  /// Where other robots of its island stood when the patch was made; metres, the patch's frame.
  [[nodiscard]] std::vector<Vector2d> about(const Map& map, PatchId patch) const;

 private:
  struct OfPatch {
    RobotId robot;
    double stamp = 0;
    std::vector<ManifoldPoint> others;
  };
  std::vector<OfPatch> of_patch_;
};

}  // namespace helicoid
