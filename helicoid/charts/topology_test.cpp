#include "helicoid/charts/topology.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

/// Patches in a ring, each a neighbour of the next two on either side.
Neighbours ring_of(std::size_t count) {
  Neighbours neighbours(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::size_t step : {std::size_t{1}, std::size_t{2}, count - 2, count - 1}) {
      neighbours[i].push_back(make_id<PatchId>((i + step) % count));
    }
    std::sort(neighbours[i].begin(), neighbours[i].end());
  }
  return neighbours;
}

Topology make(double spacing) {
  const synthetic::Builder builder = synthetic::pillar_map();
  return make_topology(builder.map, builder.patches(), ring_of(16), {1, std::vector<int>(16, 0)}, spacing);
}

TEST(Topology, WithoutSpacingHasANodeForEveryPatchAndAnEdgeForEveryPairOfNeighbours) {
  const Topology topology = make(0);
  EXPECT_EQ(topology.nodes.size(), 16U);
  EXPECT_EQ(topology.edges.size(), 32U);
}

TEST(Topology, ThinnedStandsForEveryPatchOnce) {
  const Topology topology = make(1.5);
  int patches = 0;
  for (const TopologyNode& node : topology.nodes) patches += node.patches;
  EXPECT_EQ(patches, 16);
  EXPECT_LT(topology.nodes.size(), 12U);
}

TEST(Topology, StaysConnectedWhenThinned) {
  const Topology topology = make(2);
  std::vector<std::size_t> group(topology.nodes.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = i;
  for (std::size_t round = 0; round < group.size(); ++round) {
    for (const TopologyEdge& edge : topology.edges) {
      group[edge.a] = group[edge.b] = std::min(group[edge.a], group[edge.b]);
    }
  }
  for (const std::size_t g : group) EXPECT_EQ(g, 0U);
}

TEST(Topology, IsGeoJsonInLocalMetres) {
  const Topology topology = make(1.5);
  const nlohmann::json json = nlohmann::json::parse(to_geojson(topology));
  EXPECT_EQ(json["type"], "FeatureCollection");
  ASSERT_EQ(json["features"].size(), topology.nodes.size() + topology.edges.size());
  const auto& first = json["features"][0];
  EXPECT_EQ(first["type"], "Feature");
  EXPECT_EQ(first["geometry"]["type"], "Point");
  EXPECT_NEAR(first["geometry"]["coordinates"][0], topology.nodes[0].p_plane.x(), 1e-3);
  EXPECT_EQ(first["properties"]["island"], 0);
  const auto& last = json["features"].back();
  EXPECT_EQ(last["geometry"]["type"], "LineString");
  EXPECT_EQ(last["geometry"]["coordinates"].size(), 2U);
  EXPECT_EQ(last["properties"]["a"], topology.edges.back().a);
}

TEST(Topology, OfNothingIsAnEmptyCollection) {
  EXPECT_TRUE(nlohmann::json::parse(to_geojson({}))["features"].empty());
}

}  // namespace
}  // namespace helicoid
