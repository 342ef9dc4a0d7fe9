// The one way to change a Map. Only `mapping` (and `store`, when it reads a map back) may include this file; a test
// of the rooms enforces it.
#pragma once

#include "helicoid/manifold/map.hpp"

namespace helicoid {

class MapEditor {
 public:
  explicit MapEditor(Map& map) : map_(map) {}

  RobotId add_robot(std::string name, std::vector<LaserModel> lasers);
  IslandId add_island();
  /// The patch's id must be the next free one.
  PatchId add_patch(Patch patch, const Pose2& T_plane_patch, IslandId island);
  RelationId add_relation(const Relation& relation);
  /// What is known of the same pair of patches now.
  void revise_relation(RelationId id, const Relation& now);
  /// All patches of `from` move by T_into_from (their planes') and belong to `into` from then on.
  void merge_islands(IslandId into, IslandId from, const Pose2& T_into_from);
  void set_pose(PatchId id, const Pose2& T_plane_patch);
  void append_scan(RobotId robot, const TrackedScan& scan);

 private:
  Map& map_;
};

}  // namespace helicoid
