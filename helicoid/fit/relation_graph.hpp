// A graph of relations (III-B): what goes into a fit. It knows no map.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "helicoid/fit/measurement.hpp"

namespace helicoid {

/// As a relation's `a`: the frame in which all poses are given. Priors are relations to it.
inline constexpr std::uint32_t kWorld = std::numeric_limits<std::uint32_t>::max();

struct GraphRelation {
  std::uint32_t a = 0;  ///< a node, or kWorld
  std::uint32_t b = 0;  ///< a node, not a
  Measurement measurement;
  bool may_be_wrong = false;  ///< robust losses act on it; on a robot's own chain they must not (design 5.2)
};

/// Nodes are poses, or landmarks: places without a heading, whose yaw is held at 0.
struct RelationGraph {
  std::vector<Pose2> poses;       ///< T_plane_node, the start of the fit
  std::vector<bool> is_landmark;  ///< empty: none is
  std::vector<GraphRelation> relations;
};

/// The parts of a graph that no relation ties to one another; a prior ties to the world.
struct Component {
  std::vector<std::uint32_t> nodes;  ///< ascending
  bool has_prior = false;            ///< an absolute relation: the part needs no gauge
};
[[nodiscard]] std::vector<Component> find_components(const RelationGraph& graph);

/// The gauge: the first pose of every component that no prior ties to the world.
[[nodiscard]] std::vector<std::uint32_t> default_gauge(const RelationGraph& graph);
/// The same where these nodes are held anyway: those, and the first pose of every component that has none of them.
[[nodiscard]] std::vector<std::uint32_t> gauge_with(const RelationGraph& graph, std::span<const std::uint32_t> held);

/// Residuals less unknowns, held nodes not counted; correspondences count three residuals a pair.
[[nodiscard]] std::int64_t degrees_of_freedom(const RelationGraph& graph, std::span<const std::uint32_t> held);
/// With the default gauge.
[[nodiscard]] std::int64_t degrees_of_freedom(const RelationGraph& graph);

/// What correspondences cost at their own best, chi^2 / 2: no contradiction between relations.
[[nodiscard]] double least_cost(const RelationGraph& graph);

}  // namespace helicoid
