#include "helicoid/manifold/map.hpp"

#include <algorithm>
#include <cassert>

#include "helicoid/manifold/map_editor.hpp"

namespace helicoid {

const char* name_of(RelationKind kind) {
  switch (kind) {
    case RelationKind::odometry: return "odometry";
    case RelationKind::chain: return "chain";
    case RelationKind::overlap: return "overlap";
    case RelationKind::closure: return "closure";
    case RelationKind::sighting: return "sighting";
  }
  return "unknown";
}

std::vector<Island> Map::islands() const {
  std::vector<Island> all(island_count_);
  for (std::size_t i = 0; i < island_count_; ++i) all[i].id = make_id<IslandId>(i);
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    all[island_of_[i].index()].patches.push_back(make_id<PatchId>(i));
  }
  std::erase_if(all, [](const Island& island) { return island.patches.empty(); });
  return all;
}

Island Map::island_with(PatchId id) const {
  Island island{island_of(id), {}};
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    if (island_of_[i] == island.id) island.patches.push_back(make_id<PatchId>(i));
  }
  return island;
}

std::vector<PatchId> Map::patches_about(PatchId id, double radius) const {
  const Vector2d p = T_plane_patch(id).translation();
  std::vector<PatchId> about;
  index_.for_each_about(island_of(id), p, radius, [&](PatchId other) {
    if ((T_plane_patch(other).translation() - p).squaredNorm() <= radius * radius) about.push_back(other);
  });
  std::sort(about.begin(), about.end());
  return about;
}

RobotId MapEditor::add_robot(std::string name, std::vector<LaserModel> lasers) {
  map_.robots_.push_back({std::move(name), std::move(lasers), {}});
  return make_id<RobotId>(map_.robots_.size() - 1);
}

IslandId MapEditor::add_island() {
  return make_id<IslandId>(map_.island_count_++);
}

PatchId MapEditor::add_patch(Patch patch, const Pose2& T_plane_patch, IslandId island) {
  assert(patch.id.index() == map_.patches_.size());
  assert(island.index() < map_.island_count_);
  const PatchId id = patch.id;
  map_.patches_.push_back(std::make_shared<const Patch>(std::move(patch)));
  map_.poses_.push_back(T_plane_patch);
  map_.island_of_.push_back(island);
  map_.incident_.emplace_back();
  map_.index_.place(id, island, T_plane_patch.translation());
  return id;
}

RelationId MapEditor::add_relation(const Relation& relation) {
  assert(relation.a < relation.b && relation.b.index() < map_.patches_.size());
  const auto id = make_id<RelationId>(map_.relations_.size());
  map_.relations_.push_back(relation);
  map_.incident_[relation.a.index()].push_back(id);
  map_.incident_[relation.b.index()].push_back(id);
  return id;
}

void MapEditor::revise_relation(RelationId id, const Relation& now) {
  Relation& relation = map_.relations_[id.index()];
  assert(relation.a == now.a && relation.b == now.b);
  relation = now;
}

void MapEditor::merge_islands(IslandId into, IslandId from, const Pose2& T_into_from) {
  for (std::size_t i = 0; i < map_.patches_.size(); ++i) {
    if (map_.island_of_[i] != from) continue;
    map_.island_of_[i] = into;
    set_pose(make_id<PatchId>(i), T_into_from * map_.poses_[i]);
  }
}

void MapEditor::set_pose(PatchId id, const Pose2& T_plane_patch) {
  map_.poses_[id.index()] = T_plane_patch;
  map_.index_.place(id, map_.island_of(id), T_plane_patch.translation());
}

void MapEditor::append_scan(RobotId robot, const TrackedScan& scan) {
  map_.robots_[robot.index()].trajectory.push_back(scan);
}

}  // namespace helicoid
