// Where in a wide window does a place fit a reference, and does it fit elsewhere as well? Branch and bound over all
// placements: exact on its grid, however many local optima there are (after Olson 2009; Hess et al. 2016).
#pragma once

#include "helicoid/align/score_pyramid.hpp"

namespace helicoid {

struct PlaceWindow {
  Pose2 T_reference_scan;  ///< the middle
  double half_width = 2;   ///< along either axis, metres
  /// Of it only what lies within this ellipse about the middle: offsets p with p^T limit p <= 1. Zero: all of it.
  Matrix2d limit = Matrix2d::Zero();
  double half_turn = 0.3;      ///< radians
  double turn_step = 0.04;     ///< between the headings that are tried, radians
  double least_score = 0.4;    ///< placements that score less are not looked for
  double apart = 0.6;          ///< a placement this far from the best one is another one, metres
  double turned_apart = 0.25;  ///< or turned by this much, radians
};

struct Placement {
  Pose2 T_reference_scan;
  double score = 0;  ///< mean over the points: 1 on a surface, 0 from 30 cm on
};

struct PlaceSearch {
  Placement best;
  Placement second;  ///< the best of those apart from it; score 0: none reaches the least score
};

/// Where the points fit within the window; the pyramid is of what they are to fit. An empty result if nothing does.
[[nodiscard]] PlaceSearch search_place(const ScorePyramid& pyramid, const ScanPoints& points,
                                       const PlaceWindow& window);
/// The same for a single search.
[[nodiscard]] PlaceSearch search_place(const Reference& reference, const ScanPoints& points, const PlaceWindow& window);

}  // namespace helicoid
