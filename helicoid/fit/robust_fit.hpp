// A fit that lets wrong relations go: graduated non-convexity with truncated least squares (Yang, Antonante, Tzoumas
// and Carlone 2020, algorithm 1). Softened first until it is convex, the loss is hardened step by step.
#pragma once

#include "helicoid/fit/fit_graph.hpp"

namespace helicoid {

struct RobustFit {
  FitResult result;                  ///< costs are those of the loss itself
  std::vector<std::uint32_t> wrong;  ///< relations with no weight at the optimum
};

/// With the truncated loss; with any other loss the same as `fit`.
[[nodiscard]] RobustFit fit_robustly(const RelationGraph& graph, std::span<const std::uint32_t> fixed,
                                     const FitOptions& options);

}  // namespace helicoid
