// Maximum likelihood poses of a graph of relations (paper III-C, eq. 5-8). Levenberg-Marquardt takes undamped steps as
// long as they lower the cost; Fletcher-Reeves and gradient descent reach the same optimum slowly, without a matrix.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "helicoid/fit/elimination_order.hpp"
#include "helicoid/fit/relation_graph.hpp"
#include "helicoid/fit/robust_loss.hpp"

namespace helicoid {

/// Not positive definite: at rest, but the relations leave some direction open.
enum class FitStatus : std::uint8_t { converged, iteration_limit, not_positive_definite, nothing_to_fit, cost_rose };
enum class FitMethod : std::uint8_t { levenberg_marquardt, fletcher_reeves, gradient_descent };

struct FitOptions {
  FitMethod method = FitMethod::levenberg_marquardt;
  int max_iterations = 100;          ///< the first-order methods take a thousand times as many
  double relative_tolerance = 1e-7;  ///< of the cost: ends when a step is expected to gain less
  double step_tolerance = 1e-6;      ///< or to move every pose by less, metres or radians
  bool gives_up_early =
      false;        ///< ends with `cost_rose` at the third step that does not lower it: another start may be better
  RobustLoss loss;  ///< acts on relations that may be wrong
  Ordering ordering = Ordering::automatic;
  /// Told of each iteration as it ends, with the cost (chi^2 / 2) so far.
  std::function<void(int iteration, double cost)> progress;
};

/// CPU seconds of this thread.
struct FitTimes {
  double order_s = 0;  ///< the symbolic phase
  double linearise_s = 0;
  double factorise_s = 0;
  double solve_s = 0;
  double total_s = 0;
};

/// The fitted poses and the proof.
struct FitResult {
  FitStatus status = FitStatus::nothing_to_fit;
  std::vector<Pose2> poses;
  double initial_cost = 0;   ///< chi^2 / 2
  double final_cost = 0;     ///< chi^2 / 2
  double gradient_norm = 0;  ///< by the poses' twists, where it was last taken
  int iterations = 0;        ///< factorisations, or descents
  FitTimes times;
};

/// Fits all nodes but the `fixed` ones (the gauge: one pose of every component that no prior ties to the world).
[[nodiscard]] FitResult fit(const RelationGraph& graph, std::span<const std::uint32_t> fixed,
                            const FitOptions& options = {});
/// Holds `default_gauge(graph)`.
[[nodiscard]] FitResult fit(const RelationGraph& graph, const FitOptions& options = {});

/// One relation of patches: cost `scale` * 1/2 v^T M v of T_a_b.
struct GraphEdge {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  const PairForm* form = nullptr;  ///< outlives the call
  double scale = 1;                ///< 1 / kappa for matched beams
};
[[nodiscard]] RelationGraph make_graph(std::span<const Pose2> start, std::span<const GraphEdge> edges);

/// Fits all poses but the `fixed` one. Every pose must be tied to it by some path of edges.
[[nodiscard]] FitResult fit_graph(std::span<const Pose2> start, std::span<const GraphEdge> edges, std::uint32_t fixed,
                                  const FitOptions& options = {});

}  // namespace helicoid
