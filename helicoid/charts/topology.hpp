// The topological map (the paper's fig. 6c): places and which can be reached from which.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/manifold/neighbours.hpp"
#include "helicoid/manifold/sheets.hpp"

namespace helicoid {

struct TopologyNode {
  PatchId patch;     ///< the patch that stands for the place
  Vector2d p_plane;  ///< metres
  IslandId island;
  int sheet = 0;
  int patches = 1;  ///< how many patches it stands for, itself included
};
struct TopologyEdge {
  std::size_t a = 0, b = 0;  ///< nodes, a < b
};
struct Topology {
  std::vector<TopologyNode> nodes;
  std::vector<TopologyEdge> edges;  ///< ascending
};

/// Thins the patches out: in order of id, a patch stands for itself unless a neighbour within `spacing` [m] already is
/// a node, which then stands for it too. Two nodes are joined if any patches of theirs are neighbours. With spacing 0
/// every patch is a node.
[[nodiscard]] Topology make_topology(const Map& map, std::span<const PatchId> patches, const Neighbours& neighbours,
                                     const Sheets& sheets, double spacing = 1.5);

/// GeoJSON (RFC 7946): Points with island, sheet, patch; LineStrings with the nodes that they join. Coordinates are not
/// degrees but metres in the island's plane, which the collection says in its member "coordinates".
[[nodiscard]] std::string to_geojson(const Topology& topology);
[[nodiscard]] Result<void> write_topology(const Topology& topology, const std::string& path);

}  // namespace helicoid
