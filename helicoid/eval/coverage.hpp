// Does the truth lie where it was said to lie? Normalised errors and coverage over many relative poses.
#pragma once

#include "helicoid/geometry/covariance.hpp"

namespace helicoid {

/// Errors beside what was stated of them. The normalised error squared (NEES; Bar-Shalom et al. 2001, section 5.4) has
/// as many degrees of freedom as a pose: its mean over three is 1 where covariances are honest, larger where they are
/// too small.
class Coverage {
 public:
  void add(const UncertainPose2& stated, const Pose2& T_a_b_true);
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double nees_per_freedom() const;
  /// How often x (0), y (1) or yaw (2) lay inside its own 95 % interval.
  [[nodiscard]] double inside_percent(int component) const;
  /// How often all three lay inside the 95 % region together.
  [[nodiscard]] double region_percent() const;

 private:
  std::size_t count_ = 0;
  double nees_ = 0;
  std::size_t inside_region_ = 0;
  std::size_t inside_[3] = {};
};

}  // namespace helicoid
