// What a planar map would do: routes on one occupancy grid of a whole island, whatever lies over what. The yardstick
// for routes on the manifold.
#pragma once

#include <memory>

#include "helicoid/navigation/plan_route.hpp"

namespace helicoid {

class PlanarFloor;

/// Keeps its grid from one plan to the next while the map does not change.
class PlanarPlanner {
 public:
  explicit PlanarPlanner(const NavigationOptions& options = {});
  ~PlanarPlanner();
  PlanarPlanner(PlanarPlanner&&) noexcept;
  PlanarPlanner& operator=(PlanarPlanner&&) noexcept;

  /// The cheapest way (A*; a metre costs more the less room there is, as on the manifold) over the free cells (5 cm) of
  /// the grid of the robot's island that keeps the least clearance from all that is not free, pulled taut. Its points
  /// are given in the plane, that is in the frame of the island's first patch.
  [[nodiscard]] ManifoldRoute plan(const Map& map, const ManifoldPose& from, const ManifoldPoint& goal);

 private:
  const PlanarFloor& floor_of(const Map& map, IslandId island);

  NavigationOptions options_;
  std::unique_ptr<PlanarFloor> floor_;
  std::vector<Pose2> poses_;  ///< of the map that it was drawn from
  IslandId island_;
  std::vector<PatchId> patches_;
};

}  // namespace helicoid
