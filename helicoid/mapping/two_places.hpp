// What was seen about two places, and whether either contradicts what was seen about the other.
#pragma once

#include <span>
#include <vector>

#include "helicoid/align/align_scan.hpp"
#include "helicoid/mapping/local_map.hpp"

namespace helicoid {

/// Patches as seen from b.
[[nodiscard]] std::vector<LocalPatch> views_of_place(const Map& map, PatchId b, std::span<const PatchId> place);
/// The points of views in the frame that these are given in, some hundred at most. Only what stood still while they
/// were taken has weight: nothing that one of them saw through.
[[nodiscard]] ScanPoints standing_points(const Map& map, std::span<const LocalPatch> views);

/// What is compared: what was seen about b, and what was seen about a.
struct TwoPlaces {
  std::vector<LocalPatch> views_a, views_b;  ///< in a's and in b's frame
  ScanPoints points_a, points_b;             ///< the same
  Reference reference;                       ///< of a's surfaces
  AlignOptions align;
};

/// The share of the points of either that lie deep in what was seen as free about the other, of that which has more:
/// what stood there only then, and what stands there only now. What does not stand still tells nothing.
[[nodiscard]] double contradicted_share(const Map& map, const TwoPlaces& places, const Pose2& T_a_b);

/// Where that stands, in b's frame: the middle of the points of that which has the larger share of them.
[[nodiscard]] Vector2d middle_of_contradiction(const Map& map, const TwoPlaces& places, const Pose2& T_a_b);

}  // namespace helicoid
