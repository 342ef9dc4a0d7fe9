// A new patch's relations to the local map, and the fit of its pose alone (paper IV-A steps 3 and 4, eq. 13).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "helicoid/align/align_scan.hpp"
#include "helicoid/align/match_pair.hpp"
#include "helicoid/mapping/local_map.hpp"

namespace helicoid {

struct RelateOptions {
  int rounds = 3;                   ///< of matching and fitting at most, EM-style
  double settled_position = 0.004;  ///< a fit that moves less ends the rounds, metres
  double settled_heading = 0.002;   ///< radians
  int min_correspondences = 20;
  /// Of what the two views say of the same places, this share at least must agree: correspondences, against points of
  /// either that lie deep in what the other saw as free.
  double least_agreeing = 0.5;
  double deep = 0.15;  ///< metres
};

/// The correspondences of two patches that stand so, by what their lasers are.
[[nodiscard]] PairMatch match_patches(const Patch& a, const Patch& b, const Pose2& T_a_b);

/// About where it was made a match holds: half the points' usual spacing (design 5.1), metres.
inline constexpr double kMatchRadius = 0.035;

/// A relation's pair matched anew at this relative pose; nothing if they hardly match or contradict each other there.
[[nodiscard]] std::optional<Relation> match_anew(const Map& map, const Relation& relation, const Pose2& T_a_b,
                                                 const RelateOptions& options = {});

struct RelatedPatch {
  Pose2 T_anchor_patch;             ///< of the new patch, eq. 13
  std::vector<Relation> relations;  ///< of a local patch (a) with the new one (b), of kind overlap
};

/// Matches a new patch that stands about at `prior` against each of the views, fits its pose against all of them
/// together, and repeats. Views that it contradicts are left out: things may have moved, or it stands elsewhere.
[[nodiscard]] RelatedPatch relate(const Map& map, std::span<const LocalPatch> views, const Patch& patch,
                                  const PosePrior& prior, const RelateOptions& options = {});

}  // namespace helicoid
