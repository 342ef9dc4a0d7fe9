// How well a sighting fits a relative pose of the two robots.
#pragma once

#include <optional>

#include "helicoid/geometry/covariance.hpp"
#include "helicoid/sensor/event.hpp"

namespace helicoid {

struct SightingFit {
  double chi2 = 0;       ///< of what was measured, by its own noise and that of the pose together
  int measurements = 0;  ///< range, bearing, orientation
  /// True if chance alone would lead to more in one of a thousand true sightings.
  [[nodiscard]] bool agrees() const;
};

/// False if a measured value is not finite or has no standard deviation.
[[nodiscard]] bool is_usable(const Sighting& sighting);

/// Of a usable sighting, to the first order about the pose.
[[nodiscard]] SightingFit fit_of(const Sighting& sighting, const UncertainPose2& T_observer_observed);

/// The relative pose that a sighting with range, bearing and orientation is of; nothing if one of them is missing.
[[nodiscard]] std::optional<UncertainPose2> whole_pose(const Sighting& sighting);

}  // namespace helicoid
