// The manifold map: patches, relations, islands and where every scan was taken. It holds and answers; it decides
// nothing. Reading is free; writing goes through MapEditor (map_editor.hpp), which only `mapping` and `store` use.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "helicoid/manifold/patch.hpp"
#include "helicoid/manifold/plane_index.hpp"
#include "helicoid/manifold/relation.hpp"
#include "helicoid/manifold/trajectory.hpp"

namespace helicoid {

struct RobotRecord {
  std::string name;
  std::vector<LaserModel> lasers;
  Trajectory trajectory;
};

struct Island {
  IslandId id;
  std::vector<PatchId> patches;  ///< ascending; the first is the gauge
  /// Where one of its patches stands among them: its number in graph_edges.
  [[nodiscard]] std::uint32_t place_of(PatchId patch) const {
    return static_cast<std::uint32_t>(std::lower_bound(patches.begin(), patches.end(), patch) - patches.begin());
  }
};

class Map {
 public:
  [[nodiscard]] std::size_t patch_count() const { return patches_.size(); }
  [[nodiscard]] const Patch& patch(PatchId id) const { return *patches_[id.index()]; }
  /// The projected planar pose theta of eq. 1, in the island's frame.
  [[nodiscard]] const Pose2& T_plane_patch(PatchId id) const { return poses_[id.index()]; }
  [[nodiscard]] std::span<const Pose2> poses() const { return poses_; }
  [[nodiscard]] IslandId island_of(PatchId id) const { return island_of_[id.index()]; }

  /// The patches of its island whose origins lie this near to its own in the plane, itself included; ascending.
  [[nodiscard]] std::vector<PatchId> patches_about(PatchId id, double radius) const;

  [[nodiscard]] std::span<const Relation> relations() const { return relations_; }
  [[nodiscard]] const Relation& relation(RelationId id) const { return relations_[id.index()]; }
  /// The relations in which a patch takes part, in the order in which they were made.
  [[nodiscard]] std::span<const RelationId> relations_of(PatchId id) const { return incident_[id.index()]; }

  [[nodiscard]] std::span<const RobotRecord> robots() const { return robots_; }
  [[nodiscard]] const RobotRecord& robot(RobotId id) const { return robots_[id.index()]; }

  /// The islands, by id, empty ones left out.
  [[nodiscard]] std::vector<Island> islands() const;
  /// The island that a patch is on.
  [[nodiscard]] Island island_with(PatchId id) const;
  /// Island ids given out so far, those of emptied islands included.
  [[nodiscard]] std::size_t island_count() const { return island_count_; }

  /// The paper's r (+) theta: where a manifold pose projects to in the island's plane.
  [[nodiscard]] Pose2 project(const ManifoldPose& pose) const {
    return oplus(pose.T_patch_robot, T_plane_patch(pose.patch));
  }
  /// Eq. 3: the same point of the manifold relative to another patch (which must overlap: see neighbours.hpp).
  [[nodiscard]] ManifoldPose express(const ManifoldPose& pose, PatchId patch) const {
    return {patch, ominus(project(pose), T_plane_patch(patch))};
  }

 private:
  friend class MapEditor;
  std::vector<std::shared_ptr<const Patch>> patches_;
  std::vector<Pose2> poses_;
  std::vector<IslandId> island_of_;
  PlaneIndex index_;
  std::vector<Relation> relations_;
  std::vector<std::vector<RelationId>> incident_;
  std::vector<RobotRecord> robots_;
  std::size_t island_count_ = 0;
};

}  // namespace helicoid
