// A map while loops are closed in it: relations that are added, and which are still to be made.
#pragma once

#include <span>
#include <vector>

#include "helicoid/manifold/map_editor.hpp"
#include "helicoid/mapping/relate.hpp"

namespace helicoid {

/// The map that is being changed and the information of its relations, which must follow.
struct MapInProgress {
  const Map& map;
  MapEditor& editor;
  InformationGraph& graph;
  void add(const Relation& relation);
};

/// True if two patches were kept by one robot within a few metres of its way. `along`: how far along its robot's way
/// each patch was kept, metres.
[[nodiscard]] bool is_same_stretch(const Map& map, PatchId p, PatchId q, std::span<const double> along);

/// True if a relation ties the two patches that is not odometry's.
[[nodiscard]] bool are_matched(const Map& map, PatchId p, PatchId q);

/// True if some relation of the patch already leads to q's stretch of way: one patch of a stretch is enough to relate
/// to.
[[nodiscard]] bool is_tied_to_stretch(const Map& map, PatchId patch, PatchId q, std::span<const double> along);

/// Patches this near to one another show the same place, metres.
inline constexpr double kSamePlace = 3;

/// True if q lies within `reach` of the patch, on the same island, and its stretch of way is not yet related to.
[[nodiscard]] bool is_untied_ground(const Map& map, PatchId patch, PatchId q, std::span<const double> along,
                                    double reach = kSamePlace);

/// The older patches about which is_untied_ground may hold: those of the island that lie near enough; ascending.
[[nodiscard]] std::vector<PatchId> older_patches_about(const Map& map, PatchId patch, double reach = kSamePlace);

/// Relates a patch to the views, all of them older, and adds the relations.
RelatedPatch relate_to(MapInProgress& progress, PatchId b, std::span<const LocalPatch> views, const PosePrior& prior,
                       RelationKind kind);

}  // namespace helicoid
