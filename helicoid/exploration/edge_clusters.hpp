// The manifold's open edge, cut into stretches that one look can deal with.
#pragma once

#include <vector>

#include "helicoid/exploration/open_edges.hpp"

namespace helicoid {

/// A point of the open edge, in its island's plane.
struct EdgePoint {
  PatchId patch;
  Vector2d p_plane;
  Vector2d outward_plane;
};

/// Points that hang together on one sheet.
struct EdgeCluster {
  IslandId island;
  std::vector<EdgePoint> points;  ///< by patch and place on its boundary
  Vector2d middle_plane = Vector2d::Zero();
  Vector2d outward_plane = Vector2d::Zero();  ///< mean, not a unit vector where the edge bends
  double length = 0;                          ///< metres
};

struct ClusterOptions {
  double link = 0.25;     ///< points nearer than this hang together, metres
  double shortest = 0.2;  ///< shorter stretches are left out, metres
  double longest = 3.0;   ///< longer ones are cut, metres
};
[[nodiscard]] std::vector<EdgeCluster> cluster_edges(const Map& map, const OpenEdges& edges,
                                                     const ClusterOptions& options = {});

}  // namespace helicoid
