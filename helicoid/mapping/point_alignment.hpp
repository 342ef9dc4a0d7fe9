// A rigid transform from pairs of points of which some are wrong.
#pragma once

#include <span>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// The same thing as two frames have it, metres.
struct PointPair {
  Vector2d p_a = Vector2d::Zero();
  Vector2d p_b = Vector2d::Zero();
};

struct PointAlignment {
  bool determined = false;   ///< enough pairs agree, and they do not all lie in one place
  Pose2 T_a_b;               ///< of the pairs that agree, least squares
  std::size_t agreeing = 0;  ///< pairs
};

struct PointAlignmentOptions {
  double tolerance = 0.6;        ///< pairs agree that are brought so near to each other, metres
  double spread = 0.7;           ///< the agreeing points' standard deviation along their line, metres
  std::size_t least_pairs = 6;   ///< that must agree
  double least_share = 0.5;      ///< of all pairs
  std::size_t most_tested = 40;  ///< pairs that hypotheses are made of, evenly taken
};

/// The transform that most pairs agree on (a consensus of hypotheses from two pairs each: Fischler and Bolles 1981,
/// without their chance).
[[nodiscard]] PointAlignment align_pairs(std::span<const PointPair> pairs, const PointAlignmentOptions& options = {});

}  // namespace helicoid
