// A snapshot of what can be driven on a manifold map: routes (plan_route.hpp) and distances (distance_field.hpp) are
// asked of it. Design 5.7.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "helicoid/navigation/floor_plan.hpp"
#include "helicoid/navigation/manifold_point.hpp"

namespace helicoid {

/// Where nobody is to go: a part of the plane about a patch, on all sheets.
struct ForbiddenFloor {
  PatchId frame;
  std::vector<Vector2d> ring_patch;  ///< an open ring, in the patch's frame, metres
};
/// By the even-odd rule.
[[nodiscard]] bool lies_in(std::span<const Vector2d> ring, const Vector2d& p);

class NavigableMap {
 public:
  /// `neighbours` are the map's own, as find_neighbours has them now. `before`: an earlier snapshot of the same map, of
  /// which all that still holds is taken over; not one of a map from before a replay.
  NavigableMap(const Map& map, const Neighbours& neighbours, const NavigationOptions& options = {},
               const NavigableMap* before = nullptr);

  /// From now on no route and no distance leads through these, but from one that starts there.
  void forbid(std::span<const ForbiddenFloor> regions);
  /// By number of place (see FloorPlan) as search_floor takes them: what a robot that starts here may not drive
  /// through.
  [[nodiscard]] std::vector<bool> forbidden_from(const FloorPlace& start) const;

  [[nodiscard]] bool is_forbidden(const ManifoldPoint& point) const;

  [[nodiscard]] const NavigationOptions& options() const { return plan_->options; }
  /// Patches that the snapshot knows: points on newer ones are off the ground.
  [[nodiscard]] std::size_t patch_count() const { return plan_->T_plane_patch.size(); }
  /// Where a point projected to when the snapshot was taken.
  [[nodiscard]] Vector2d project(const ManifoldPoint& point) const {
    return plan_->T_plane_patch[point.patch.index()] * point.p_patch;
  }
  /// The distance to what a robot there could touch or does not know, up to 0.8 m; 0 off the ground. Counts only what
  /// the patch and its neighbours say: their sheet.
  [[nodiscard]] double clearance(const ManifoldPoint& point) const;
  /// True where a robot may drive through.
  [[nodiscard]] bool is_passable(const ManifoldPoint& point) const;

  [[nodiscard]] const std::shared_ptr<const FloorPlan>& plan() const { return plan_; }

 private:
  std::shared_ptr<const FloorPlan> plan_;
  std::vector<bool> forbidden_;  ///< by number of place; empty: nothing is
};

}  // namespace helicoid
