// A map against the simulated building that it is of (contract: *helicoid explore*).
#pragma once

#include <span>

#include "apps/map_outputs.hpp"
#include "helicoid/eval/map_quality.hpp"
#include "helicoid/simulation/true_relations.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

/// What robots of this radius could do from these starts is measured once, for many maps of one building.
class BuildingTruth {
 public:
  /// Errors: a world too large for the raster.
  [[nodiscard]] static Result<BuildingTruth> of(const World& world, std::span<const Pose2> starts, double radius);

  /// Every island is a chart of its own, laid on the building by its robots' true ways and its walls.
  [[nodiscard]] MapQuality judge(const Map& map, std::span<const TrueTrack> tracks) const;
  [[nodiscard]] double reachable_m2() const { return reachable_m2_; }

 private:
  std::vector<Segment> walls_, seen_walls_;
  std::vector<Vector2d> reachable_;
  double cell_ = 0.05;
  double reachable_m2_ = 0;
};

}  // namespace helicoid
