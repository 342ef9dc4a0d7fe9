// A fit that lets wrong relations go, by truncated least squares. Where trusted relations tie all poses it begins at
// what agrees with them (consistent_start.hpp); where they do not, by graduated non-convexity: softened first until it
// is convex, the loss is hardened step by step (Yang, Antonante, Tzoumas and Carlone 2020, algorithm 1).
#pragma once

#include "helicoid/fit/fit_graph.hpp"

namespace helicoid {

struct RobustFit {
  FitResult result;                  ///< costs are those of the loss itself
  std::vector<std::uint32_t> wrong;  ///< relations with no weight at the optimum
  double width = 0;                  ///< of the loss at the end: as asked for, or as ConsistentStart::gate says
};

/// With the truncated loss; with any other loss the same as `fit`.
[[nodiscard]] RobustFit fit_robustly(const RelationGraph& graph, std::span<const std::uint32_t> fixed,
                                     const FitOptions& options);

}  // namespace helicoid
