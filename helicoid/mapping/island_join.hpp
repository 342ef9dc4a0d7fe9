// From sightings to the relative pose of two islands (paper IV-C): as soon as, and not before, they determine it.
#pragma once

#include <span>

#include "helicoid/manifold/map.hpp"
#include "helicoid/sensor/event.hpp"

namespace helicoid {

/// A sighting with both robots placed on the manifold at its time.
struct PlacedSighting {
  ManifoldPose observer;
  ManifoldPose observed;
  Sighting sighting;
};

/// How two patches of two islands lie to each other.
struct IslandJoin {
  bool determined = false;  ///< all three degrees of freedom, and by one optimum alone
  PatchId a, b;             ///< of the last sighting; a < b
  Pose2 T_a_b;
  Matrix3d information = Matrix3d::Zero();  ///< of (x, y, yaw) of T_a_b
  double chi2 = 0;                          ///< of all the sightings at the optimum
  int measurements = 0;                     ///< ranges, bearings and orientations
};

struct IslandJoinOptions {
  double position = 1.0;  ///< determined if known better than this (1.96 sigma), metres
  double heading = 0.5;   ///< and this, radians
  double rival = 9;       ///< another optimum must have this much more chi^2
};

/// The most likely relative pose given sightings, each of which has one robot on either of two islands. Several starts:
/// ranges and bearings alone have more than one optimum.
[[nodiscard]] IslandJoin estimate_join(const Map& map, std::span<const PlacedSighting> sightings,
                                       const IslandJoinOptions& options = {});

}  // namespace helicoid
