#include "helicoid/manifold/confidence.hpp"

#include <algorithm>

namespace helicoid {

double information_divisor(const Map& map, const Relation& relation) {
  const bool single = relation.kind == RelationKind::odometry || relation.kind == RelationKind::sighting;
  return single ? 1 : map.patch(relation.b).laser.kappa;
}

namespace {

void add_information(const Map& map, const Relation& r, InformationGraph& graph) {
  const Pose2 T_a_b = map.T_plane_patch(r.a).inverse() * map.T_plane_patch(r.b);
  graph.add(r.a.value, r.b.value, T_a_b, expand(r.form, T_a_b).information / information_divisor(map, r));
}

}  // namespace

void renew_information(const Map& map, std::span<const PatchId> moved, InformationGraph& graph) {
  std::vector<RelationId> relations;
  for (const PatchId id : moved) {
    for (const RelationId r : map.relations_of(id)) relations.push_back(r);
  }
  std::sort(relations.begin(), relations.end());
  relations.erase(std::unique(relations.begin(), relations.end()), relations.end());
  for (const RelationId id : relations) graph.forget(map.relation(id).a.value, map.relation(id).b.value);
  for (const RelationId id : relations) add_information(map, map.relation(id), graph);
}

InformationGraph information_graph(const Map& map) {
  InformationGraph graph;
  for (std::size_t i = 0; i < map.patch_count(); ++i) graph.add_pose();
  for (const Relation& r : map.relations()) add_information(map, r, graph);
  return graph;
}

std::vector<Pose2> island_poses(const Map& map, const Island& island) {
  std::vector<Pose2> poses;
  poses.reserve(island.patches.size());
  for (const PatchId id : island.patches) poses.push_back(map.T_plane_patch(id));
  return poses;
}

std::vector<GraphEdge> graph_edges(const Map& map, const Island& island) {
  std::vector<std::uint32_t> place(map.patch_count(), 0);
  for (std::size_t i = 0; i < island.patches.size(); ++i) {
    place[island.patches[i].index()] = static_cast<std::uint32_t>(i);
  }
  std::vector<GraphEdge> edges;
  for (const Relation& r : map.relations()) {
    if (map.island_of(r.a) != island.id) continue;
    edges.push_back({place[r.a.index()], place[r.b.index()], &r.form, 1 / information_divisor(map, r)});
  }
  return edges;
}

BoundOptions bound_options(const Patch& reference, double position, double heading, double radius) {
  BoundOptions options;
  options.position = position;
  options.heading = heading;
  options.radius = radius;
  options.floor_position = reference.laser.floor_position;
  options.floor_heading = reference.laser.floor_heading;
  return options;
}

}  // namespace helicoid
