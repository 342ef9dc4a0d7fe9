// A trajectory against a true one: absolute error after one rigid alignment, and relative error over a second.
#pragma once

#include <span>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

struct TrajectoryError {
  std::size_t matched = 0;  ///< poses with a true pose at their stamp
  double ate_m = 0;         ///< RMS distance after the best rigid alignment
  double rpe_m = 0;         ///< RMS error of the displacement over `interval`
  double rpe_deg = 0;       ///< RMS error of the turn over it
};

/// Pairs poses and truth by stamp (the nearest within `tolerance`, seconds); both in order of time.
/// `interval`: over which relative errors are taken, seconds.
[[nodiscard]] TrajectoryError trajectory_error(std::span<const double> stamps, std::span<const Pose2> poses,
                                               std::span<const double> true_stamps, std::span<const Pose2> truth,
                                               double tolerance = 1e-3, double interval = 1);

/// The rigid transform that best takes points to targets, least squares (Umeyama 1991, without scale).
[[nodiscard]] Pose2 align_points(std::span<const Vector2d> points, std::span<const Vector2d> targets);

}  // namespace helicoid
