// The manifold's edge (design 5.7): the stretches of patches' free-space boundary that are neither obstacle nor covered
// by a neighbour on the same sheet.
#pragma once

#include <memory>
#include <vector>

#include "helicoid/exploration/patch_view.hpp"
#include "helicoid/manifold/neighbours.hpp"
#include "helicoid/manifold/patch_set.hpp"

namespace helicoid {

struct OpenEdgeOptions {
  PatchViewOptions view;
  double beyond = 0.12;  ///< what must be unknown: the place this far outside the boundary, metres
  /// An edge is compared anew when a patch has moved by more than this (a re-fit, a closure).
  double moved = 0.03;           ///< metres
  double turned = radians(0.4);  ///< radians
  /// What is known to this of a patch is no other place: it tells what lies behind the patch's edge, even where it is
  /// not confident enough to be a neighbour. Sheets part where a map could be wrong by more.
  NeighbourOptions same_place{1.0, 0.3};
};

/// Kept from one call to the next: a patch's content never changes, so that each pair of patches is compared once,
/// until a fit moves them.
class OpenEdges {
 public:
  explicit OpenEdges(const OpenEdgeOptions& options = {}) : options_(options) {}

  /// Takes in what the map has become.
  void update(const Map& map, const Neighbours& neighbours);

  /// What is open of a patch's boundary.
  [[nodiscard]] const std::vector<OpenPoint>& of(PatchId id) const { return edges_[id.index()].open; }
  /// The patches that may tell about what lies around a patch: its neighbours and theirs, and what else is the same
  /// place, itself included; ascending.
  [[nodiscard]] const std::vector<PatchId>& around(PatchId id) const { return edges_[id.index()].around; }
  [[nodiscard]] const PatchSet& set_around(PatchId id) const { return edges_[id.index()].near; }
  [[nodiscard]] bool same_sheet(PatchId a, PatchId b) const { return edges_[a.index()].near.contains(b.index()); }
  [[nodiscard]] const PatchView& view(PatchId id) const { return *edges_[id.index()].view; }
  [[nodiscard]] std::size_t size() const { return edges_.size(); }

 private:
  struct Edge {
    std::unique_ptr<PatchView> view;
    std::vector<OpenPoint> open;
    std::vector<PatchId> around;
    PatchSet near;                 ///< `around` as a set
    PatchSet compared;             ///< those that `open` was compared with
    Pose2 T_plane_patch_compared;  ///< where the patch lay then
  };
  void find_around(const Map& map, const Neighbours& neighbours);
  void find_same_place(const Map& map);
  void forget_moved(const Map& map);
  void compare(const Map& map, std::size_t patch);

  OpenEdgeOptions options_;
  std::vector<Edge> edges_;
  Neighbours same_place_;
  std::size_t relations_then_ = 0;  ///< when same_place_ was found
};

}  // namespace helicoid
