// Where a fit begins. A sum of squares over poses has many local optima; a start in the right basin is half the fit.
#pragma once

#include <span>
#include <vector>

#include "helicoid/fit/relation_graph.hpp"

namespace helicoid {

/// Poses by dead reckoning: along the chain of relations from each node to the next while there are such, then along
/// a spanning tree, breadth first. Nodes that `is_placed` says are known keep their pose; empty: none is. The first
/// pose of each component that has none placed stands at the origin. Landmarks start where a point relation sees them.
[[nodiscard]] std::vector<Pose2> odometry_start(const RelationGraph& graph, const std::vector<bool>& is_placed = {});

/// The same, `held` nodes alone being known.
[[nodiscard]] std::vector<Pose2> reckon_from(const RelationGraph& graph, std::span<const std::uint32_t> held);

/// Chordal initialisation (Martinec and Pajdla 2007; Carlone et al. 2015): headings from one linear problem over
/// (cos, sin), then positions from another, both weighted and global: no start is needed. Nodes are left where dead
/// reckoning puts them if pose-pose relations and correspondences alone do not tie them. `held` nodes keep their pose.
[[nodiscard]] std::vector<Pose2> chordal_start(const RelationGraph& graph, std::span<const std::uint32_t> held = {});

}  // namespace helicoid
