#include "helicoid/charts/topology.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "helicoid/base/whole_file.hpp"

namespace helicoid {

namespace {

constexpr std::size_t kNoNode = static_cast<std::size_t>(-1);

/// The nearest neighbour that is a node already and near enough; kNoNode if there is none.
std::size_t node_near(const Map& map, PatchId id, const std::vector<PatchId>& neighbours,
                      const std::vector<std::size_t>& node_of, const Topology& topology, double spacing) {
  std::size_t best = kNoNode;
  double nearest = spacing;
  for (const PatchId other : neighbours) {
    const std::size_t node = node_of[other.index()];
    if (node == kNoNode || topology.nodes[node].patch != other) continue;
    const double distance = (topology.nodes[node].p_plane - map.T_plane_patch(id).translation()).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    best = node;
  }
  return best;
}

}  // namespace

Topology make_topology(const Map& map, std::span<const PatchId> patches, const Neighbours& neighbours,
                       const Sheets& sheets, double spacing) {
  Topology topology;
  std::vector<std::size_t> node_of(map.patch_count(), kNoNode);
  std::vector<PatchId> ordered(patches.begin(), patches.end());
  std::sort(ordered.begin(), ordered.end());
  for (const PatchId id : ordered) {
    std::size_t& node = node_of[id.index()];
    node = node_near(map, id, neighbours[id.index()], node_of, topology, spacing);
    if (node != kNoNode) {
      ++topology.nodes[node].patches;
      continue;
    }
    node = topology.nodes.size();
    const int sheet = id.index() < sheets.sheet_of.size() ? sheets.sheet_of[id.index()] : -1;
    topology.nodes.push_back({id, map.T_plane_patch(id).translation(), map.island_of(id), sheet, 1});
  }
  std::vector<std::pair<std::size_t, std::size_t>> joined;
  for (const PatchId id : ordered) {
    for (const PatchId other : neighbours[id.index()]) {
      const std::size_t a = node_of[id.index()];
      const std::size_t b = node_of[other.index()];
      if (b != kNoNode && a != b) joined.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  std::sort(joined.begin(), joined.end());
  joined.erase(std::unique(joined.begin(), joined.end()), joined.end());
  for (const auto& [a, b] : joined) topology.edges.push_back({a, b});
  return topology;
}

std::string to_geojson(const Topology& topology) {
  std::string text =
      "{\"type\": \"FeatureCollection\",\n\"coordinates\": \"metres in the island's plane, x then y; not degrees\",\n"
      "\"features\": [";
  auto out = std::back_inserter(text);
  const char* separator = "\n";
  for (std::size_t i = 0; i < topology.nodes.size(); ++i) {
    const TopologyNode& node = topology.nodes[i];
    fmt::format_to(out,
                   "{}{{\"type\": \"Feature\", \"id\": {}, \"geometry\": {{\"type\": \"Point\", \"coordinates\": "
                   "[{:.3f}, {:.3f}]}}, \"properties\": {{\"patch\": {}, \"patches\": {}, \"island\": {}, "
                   "\"sheet\": {}}}}}",
                   separator, i, node.p_plane.x(), node.p_plane.y(), node.patch.value, node.patches, node.island.value,
                   node.sheet);
    separator = ",\n";
  }
  for (const TopologyEdge& edge : topology.edges) {
    const Vector2d& a = topology.nodes[edge.a].p_plane;
    const Vector2d& b = topology.nodes[edge.b].p_plane;
    fmt::format_to(out,
                   "{}{{\"type\": \"Feature\", \"geometry\": {{\"type\": \"LineString\", \"coordinates\": "
                   "[[{:.3f}, {:.3f}], [{:.3f}, {:.3f}]]}}, \"properties\": {{\"a\": {}, \"b\": {}, \"length\": "
                   "{:.3f}}}}}",
                   separator, a.x(), a.y(), b.x(), b.y(), edge.a, edge.b, (b - a).norm());
    separator = ",\n";
  }
  return text + "\n]}\n";
}

Result<void> write_topology(const Topology& topology, const std::string& path) {
  return write_whole_file(path, to_geojson(topology));
}

}  // namespace helicoid
