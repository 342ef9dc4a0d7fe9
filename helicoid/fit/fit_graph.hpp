// Maximum likelihood poses of a graph of relations (paper III-C, eq. 5-8): sparse Gauss-Newton, damped when it must be.
#pragma once

#include <span>
#include <vector>

#include "helicoid/fit/pair_form.hpp"

namespace helicoid {

/// One relation of the graph: cost `scale` * 1/2 v^T M v of T_a_b.
struct GraphEdge {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  const PairForm* form = nullptr;  ///< outlives the call
  double scale = 1;                ///< 1 / kappa for matched beams
};

enum class FitStatus : std::uint8_t { converged, iteration_limit, not_positive_definite, nothing_to_fit };

struct FitOptions {
  int max_iterations = 20;
  double relative_tolerance = 1e-7;  ///< of the cost
  double step_tolerance = 1e-6;      ///< largest step of any pose, metres or radians
};

/// The fitted poses and the proof.
struct FitResult {
  FitStatus status = FitStatus::nothing_to_fit;
  std::vector<Pose2> poses;
  double initial_cost = 0;
  double final_cost = 0;
  double gradient_norm = 0;
  int iterations = 0;
};

/// Fits all poses but the `fixed` one (the gauge). Every pose must be tied to it by some path of edges.
[[nodiscard]] FitResult fit_graph(std::span<const Pose2> start, std::span<const GraphEdge> edges, std::uint32_t fixed,
                                  const FitOptions& options = {});

}  // namespace helicoid
