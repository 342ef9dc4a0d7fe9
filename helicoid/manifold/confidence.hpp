// How well patches are known relative to one another (paper III-C, eq. 9-10 and 12; design 5.3).
#pragma once

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/fit/local_bound.hpp"
#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// By what a relation's information is divided: beams are not independent (kappa of the laser); odometry and
/// sightings are single measurements.
[[nodiscard]] double information_divisor(const Map& map, const Relation& relation);

/// The honest information of every related pair, at the map's poses; a pose's number is its patch's id.
[[nodiscard]] InformationGraph information_graph(const Map& map);

/// Brings it up to where these patches stand now: the information of all their pairs, as information_graph has it.
void renew_information(const Map& map, std::span<const PatchId> moved, InformationGraph& graph);

/// Where an island's patches lie in its plane, by their place in `island.patches`.
[[nodiscard]] std::vector<Pose2> island_poses(const Map& map, const Island& island);

/// An island's relations as the edges of a fit; poses are numbered by their place in `island.patches`.
[[nodiscard]] std::vector<GraphEdge> graph_edges(const Map& map, const Island& island);

/// The limits of eq. 12 with the noise floor of the patch's laser.
[[nodiscard]] BoundOptions bound_options(const Patch& reference, double position, double heading, double radius);

}  // namespace helicoid
