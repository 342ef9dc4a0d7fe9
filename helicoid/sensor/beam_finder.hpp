// Which beam of a laser looks at a point, fast: for choosing what to read, not for fitting.
#pragma once

#include "helicoid/geometry/approximate_angle.hpp"
#include "helicoid/sensor/laser_model.hpp"

namespace helicoid {

class BeamFinder {
 public:
  explicit BeamFinder(const LaserModel& laser)
      : first_bearing_(static_cast<float>(laser.first_bearing)),
        half_view_(static_cast<float>(0.5 * laser.field_of_view())),
        per_step_(static_cast<float>(1 / laser.bearing_step)) {}

  /// Counted in beams from the first, between beams too; below 0 or above the last where none looks. To 2e-5 rad. The
  /// point is in the laser's frame, metres.
  [[nodiscard]] float at(float x, float y) const {
    return (approximate_wrap(approximate_atan2(y, x) - first_bearing_ - half_view_) + half_view_) * per_step_;
  }

 private:
  float first_bearing_, half_view_, per_step_;
};

}  // namespace helicoid
