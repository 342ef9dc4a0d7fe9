// What the incremental step decides by. Lengths in metres, angles in radians. One set for every log.
#pragma once

#include <cstddef>
#include <vector>

#include "helicoid/mapping/decision.hpp"

namespace helicoid {

struct MapperOptions {
  /// A patch belongs to the reference of a match if it is known to this, relative to the robot's patch (eq. 12's eps).
  double reference_position = 0.15;
  double reference_heading = 0.06;
  /// The first trigger of a new patch: this far from every patch of the local map.
  double patch_spacing = 1.0;
  double patch_turn = 0.70;
  /// For the other triggers it need only be this share of it: a place that has a patch needs no second.
  double apart_share = 0.5;
  /// The second: this share of the scan's free space is not covered by the local map.
  double new_ground_share = 0.25;
  /// And its sign in the match: fewer of the scan's points than this lie on known surfaces.
  double new_surface_share = 0.70;
  /// A robot that has kept no patch over this way, in spacings (turns count), is on known ground: all of the above are
  /// larger there by this factor.
  double known_way = 5;
  double known_ground_factor = 1.4;
  /// The local map reaches this far and holds this many patches at most.
  double local_radius = 7;
  std::size_t local_patches = 400;
  /// Patches fused into the reference, and patches that a new patch is related to.
  std::size_t reference_views = 6;
  std::size_t relation_views = 6;
  /// The reference is chosen anew when the robot has moved this far.
  double reference_renewal = 0.4;
  double reference_renewal_turn = 0.4;
  /// A match with fewer inliers is tried again from a fan of headings.
  double good_inlier_share = 0.55;
  /// One with fewer than this part of the usual share is compared with what another motion leads to.
  double usual_inlier_part = 0.85;
  /// Loops are closed when the evidence is in.
  bool closures = true;
  /// False: as in the paper (IV-B) only a sighting sets loop closing off; until then no place is compared with another.
  bool look_alikes = true;
  /// Islands are joined by what they have in common, not by sightings alone.
  bool join_on_evidence = false;
  /// What an operator has decided.
  std::vector<Decision> decisions;
};

}  // namespace helicoid
