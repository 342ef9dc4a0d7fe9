// Correspondences between two patches' scans, summed into a PairForm (eq. 4, design 5.1).
#pragma once

#include "helicoid/fit/pair_form.hpp"
#include "helicoid/geometry/pose2.hpp"
#include "helicoid/sensor/laser_model.hpp"
#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

/// The scan that supplies the lines, with what is needed to find a beam by its bearing.
struct PairReference {
  const ScanPoints* points = nullptr;
  const LaserModel* laser = nullptr;
  Pose2 T_patch_laser;
};

struct MatchPairOptions {
  double gate = 0.15;            ///< metres
  double robust_scale = 0.03;    ///< metres
  double incidence_bias = 0.03;  ///< points seen at different incidence disagree by this much a unit of cosine, metres
  double surface_bias = 0.05;    ///< the ranges to surfaces that look one way are all off by about as much, metres
  double range_sigma = 0.015;    ///< of one residual: both scans' noise, metres
};

struct PairMatch {
  PairForm form;  ///< in T_a_b: points of b on lines of a; information as if beams were independent
  int correspondences = 0;
  int candidates = 0;  ///< points of b with a normal that look at a place within a's view
  double squares = 0;  ///< weighted sum of squared residuals at T_a_b, m^2
};

/// Matches b's points to a's lines at this relative pose.
[[nodiscard]] PairMatch match_pair(const PairReference& a, const ScanPoints& b, const Pose2& T_a_b,
                                   const MatchPairOptions& options = {});

}  // namespace helicoid
