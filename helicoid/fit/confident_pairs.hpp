// Eq. 12 for many pairs at once, exact: which of them are known well enough relative to one another?
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/fit/relative_covariance.hpp"

namespace helicoid {

/// Two poses by their numbers.
struct PosePair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  friend bool operator==(const PosePair&, const PosePair&) = default;
};

/// Limits of the 95 % interval (eq. 10 with c = 1.96).
struct PairLimits {
  double position = 0.15;  ///< metres
  double heading = 0.06;   ///< radians
};

/// How well b lies relative to a midway between the two: there a turn of either moves the other by half their distance,
/// and neither is preferred. Frames as UncertainPose2 has them.
[[nodiscard]] ConfidenceInterval midway_interval(const UncertainPose2& ab);

/// Those of the pairs (a < b, ascending) whose exact midway interval keeps to the limits: what all relations of the
/// graph say together (eq. 9-10), without noise floors of scans. None if the covariance is not determined.
[[nodiscard]] std::vector<PosePair> confident_pairs(std::span<const Pose2> T_plane,
                                                    const RelativeCovariance& covariance,
                                                    std::span<const PosePair> pairs, const PairLimits& limits = {});

}  // namespace helicoid
