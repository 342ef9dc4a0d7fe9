#include "helicoid/mapping/fit_islands.hpp"

#include <algorithm>

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

void fit_islands(const Map& map, MapEditor& editor) {
  for (const Island& island : map.islands()) {
    const std::vector<Pose2> start = island_poses(map, island);
    const std::vector<GraphEdge> edges = graph_edges(map, island);
    const FitResult fit = fit_graph(start, edges, 0);
    for (std::size_t i = 0; i < start.size(); ++i) editor.set_pose(island.patches[i], fit.poses[i]);
  }
}

void choose_origins(const Map& map, MapEditor& editor) {
  for (const Island& island : map.islands()) {
    const RobotRecord* first = nullptr;
    for (const RobotRecord& robot : map.robots()) {
      if (robot.trajectory.empty() || map.island_of(robot.trajectory.front().pose.patch) != island.id) continue;
      if (first == nullptr || robot.name < first->name) first = &robot;
    }
    if (first == nullptr) continue;
    const Pose2 T_plane_origin = map.project(first->trajectory.front().pose);
    if (T_plane_origin == Pose2{}) continue;
    const Pose2 T_origin_plane = T_plane_origin.inverse();
    for (const PatchId id : island.patches) editor.set_pose(id, T_origin_plane * map.T_plane_patch(id));
  }
}

}  // namespace helicoid
