// Frontiers on the manifold (Yamauchi 1997; design 5.7): where a look would show what is not known yet.
#pragma once

#include <cstdint>
#include <map>
#include <numbers>
#include <span>
#include <vector>

#include "helicoid/exploration/edge_clusters.hpp"
#include "helicoid/exploration/ground_window.hpp"
#include "helicoid/exploration/known_floor.hpp"
#include "helicoid/exploration/travel.hpp"

namespace helicoid {

/// What a look would newly see, square by square (FloorSquare): for telling how much two looks have in common.
struct SeenSquare {
  std::int32_t row = 0;
  std::int32_t column = 0;
  double area = 0;  ///< m2
};

enum class FrontierStatus : std::uint8_t {
  open,         ///< a robot can go and look
  from_near,    ///< a robot can get near it, but not by the floor that it bounds, as far as that has been seen
  too_narrow,   ///< what lies between it and where robots can be is narrower than a robot
  unreachable,  ///< no robot has a way
};
[[nodiscard]] const char* name_of(FrontierStatus status);

struct Frontier {
  IslandId island;
  FrontierStatus status = FrontierStatus::open;
  ManifoldPoint middle;              ///< of the edge
  ManifoldPoint goal;                ///< where a robot stands to look; the middle if none can
  double heading_patch = 0;          ///< to look into, radians, in the goal's patch
  std::vector<Vector2d> edge_patch;  ///< in the middle's patch, metres
  double length = 0;                 ///< of the edge, metres
  double opening = 0;                ///< the width of the narrowest place on the way there; 0: not looked for; metres
  bool is_narrow = false;            ///< too narrow for a robot
  double gain_m2 = 0;                ///< what a look from the goal would newly see
  std::vector<SeenSquare> seen;      ///< the same, ascending by row and column
};

/// True if a robot can go where it sees it from.
[[nodiscard]] inline bool is_to_be_looked_at(const Frontier& frontier) {
  return frontier.status == FrontierStatus::open || frontier.status == FrontierStatus::from_near;
}

/// Lengths in metres.
struct FrontierOptions {
  OpenEdgeOptions edges;
  ClusterOptions clusters;
  double robot_radius = 0.20;
  double margin = 0.05;
  double look_range = 6.0;                  ///< gain is counted this far from the goal
  double field_of_view = std::numbers::pi;  ///< of the robot's laser, radians
  double goal_reach = 4.0;                  ///< a goal lies within this way of the edge
  /// An edge that no way leads to, and behind which this much may lie, is looked at from floor this near to it: a door
  /// that was seen from far along its wall only looks closed.
  double near = 2.5;
  double least_gain_near = 1.0;  ///< m2
  /// New patches about an edge that they do not touch are taken into account after so many calls.
  int renewal = 4;
  double least_gain = 0.06;  ///< less than this is not worth a look, m2
};

class FrontierFinder {
 public:
  explicit FrontierFinder(const FrontierOptions& options = {}) : options_(options), edges_(options.edges) {}

  /// By island, then in the order of the patches. `travel`: of each robot; a goal is where one of them can go.
  [[nodiscard]] std::vector<Frontier> find(const Map& map, const Neighbours& neighbours,
                                           std::span<const Travel> travel);
  [[nodiscard]] const OpenEdges& edges() const { return edges_; }

 private:
  /// What was found of an edge, and from which patches about it.
  struct Judged {
    Frontier frontier;
    std::uint64_t patches = 0;
    int age = 0;  ///< in calls
  };
  [[nodiscard]] bool holds(const Judged& before, std::uint64_t patches, std::span<const Travel> travel) const;
  [[nodiscard]] GroundWindow window_about(const Map& map, const EdgeCluster& cluster, std::span<const PatchId> patches);
  [[nodiscard]] Frontier judge(const Map& map, const EdgeCluster& cluster, std::span<const PatchId> patches,
                               std::span<const Travel> travel);

  FrontierOptions options_;
  OpenEdges edges_;
  PatchCellTable cells_;
  std::map<std::uint64_t, Judged> judged_;  ///< by their edges
};

/// The same without anything kept from one call to the next.
[[nodiscard]] std::vector<Frontier> find_frontiers(const Map& map, const Neighbours& neighbours,
                                                   std::span<const Travel> travel, const FrontierOptions& options = {});

/// What two looks have in common, m2.
[[nodiscard]] double shared_gain(const Frontier& a, const Frontier& b);

}  // namespace helicoid
