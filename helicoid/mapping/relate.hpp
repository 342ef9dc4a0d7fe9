// A new patch's relations to the local map, and the fit of its pose alone (paper IV-A steps 3 and 4, eq. 13).
#pragma once

#include <span>
#include <vector>

#include "helicoid/align/align_scan.hpp"
#include "helicoid/align/match_pair.hpp"
#include "helicoid/mapping/local_map.hpp"

namespace helicoid {

struct RelateOptions {
  MatchPairOptions match;
  double kappa = 8;
  int rounds = 3;                   ///< of matching and fitting at most, EM-style
  double settled_position = 0.004;  ///< a fit that moves less ends the rounds, metres
  double settled_heading = 0.002;   ///< radians
  int min_correspondences = 20;
};

/// The relation of a local patch (a) with the new one (b).
struct NewRelation {
  PatchId patch;
  PairForm form;
  Pose2 T_a_b;
  double c_min = 0;
  int correspondences = 0;
};

struct RelatedPatch {
  Pose2 T_anchor_patch;  ///< of the new patch, eq. 13
  std::vector<NewRelation> relations;
};

/// Matches `points` of a new patch that stands about at `prior` against each of the views, fits its pose against all
/// of them together, and repeats.
[[nodiscard]] RelatedPatch relate(const Map& map, std::span<const LocalPatch> views, const ScanPoints& points,
                                  const PosePrior& prior, const RelateOptions& options = {});

}  // namespace helicoid
