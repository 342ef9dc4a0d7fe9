#include "helicoid/mapping/fit_islands.hpp"

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

void fit_islands(const Map& map, MapEditor& editor) {
  for (const Island& island : map.islands()) {
    std::vector<Pose2> start;
    for (const PatchId id : island.patches) start.push_back(map.T_plane_patch(id));
    const std::vector<GraphEdge> edges = graph_edges(map, island);
    const FitResult fit = fit_graph(start, edges, 0);
    for (std::size_t i = 0; i < start.size(); ++i) editor.set_pose(island.patches[i], fit.poses[i]);
  }
}

}  // namespace helicoid
