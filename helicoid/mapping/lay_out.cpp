#include "helicoid/mapping/lay_out.hpp"

#include "helicoid/manifold/map_editor.hpp"

namespace helicoid {

namespace {

constexpr const char* kJoint = "-";

RobotId robot_of(MapEditor& editor, const Map& all, const std::string& name, const RobotRecord& robot) {
  for (std::size_t i = 0; i < all.robots().size(); ++i) {
    if (all.robots()[i].name == name) return make_id<RobotId>(i);
  }
  return editor.add_robot(name, robot.lasers);
}

/// Appends one; patches, relations and each robot's scans are numbered on.
void append(MapEditor& editor, const Map& all, const PlacedMap& placed, IslandId island) {
  const Map& map = *placed.map;
  const std::size_t first_patch = all.patch_count();
  const auto moved = [&](PatchId id) { return make_id<PatchId>(first_patch + id.index()); };
  std::vector<RobotId> robots;
  std::vector<std::size_t> first_scan;
  for (const RobotRecord& robot : map.robots()) {
    robots.push_back(robot_of(editor, all, placed.name + kJoint + robot.name, robot));
    first_scan.push_back(all.robot(robots.back()).trajectory.size());
  }
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    Patch patch = map.patch(make_id<PatchId>(i));
    patch.id = moved(patch.id);
    patch.scan_index += first_scan[patch.robot.index()];
    patch.robot = robots[patch.robot.index()];
    editor.add_patch(std::move(patch), placed.T_plane_map * map.T_plane_patch(make_id<PatchId>(i)), island);
  }
  for (Relation relation : map.relations()) {
    relation.a = moved(relation.a);
    relation.b = moved(relation.b);
    editor.add_relation(relation);
  }
  for (std::size_t i = 0; i < map.robots().size(); ++i) {
    for (TrackedScan scan : map.robots()[i].trajectory) {
      scan.pose.patch = moved(scan.pose.patch);
      scan.T_island_patch_online = placed.T_plane_map * scan.T_island_patch_online;
      editor.append_scan(robots[i], scan);
    }
  }
}

}  // namespace

Map lay_out(std::span<const PlacedMap> maps, std::span<const Passage> passages) {
  Map all;
  MapEditor editor(all);
  const IslandId island = editor.add_island();
  std::vector<std::size_t> first;
  for (const PlacedMap& placed : maps) {
    first.push_back(all.patch_count());
    append(editor, all, placed, island);
  }
  for (const Passage& passage : passages) {
    PatchId a = make_id<PatchId>(first[passage.map_a] + passage.a.index());
    PatchId b = make_id<PatchId>(first[passage.map_b] + passage.b.index());
    if (b < a) std::swap(a, b);
    const Pose2 T_a_b = all.T_plane_patch(a).inverse() * all.T_plane_patch(b);
    editor.add_relation({a, b, RelationKind::sighting, pose_pose_form(T_a_b, passage.information), T_a_b, 0, 0, 0});
  }
  return all;
}

}  // namespace helicoid
