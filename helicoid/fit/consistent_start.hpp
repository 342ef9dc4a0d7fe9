// A start for robust fits that wrong relations cannot pull away: from what is trusted to what agrees with it.
#pragma once

#include <span>
#include <vector>

#include "helicoid/fit/fit_graph.hpp"

namespace helicoid {

/// Relations that may be wrong are asked round by round whether they agree with the poses so far: chi^2 of the
/// innovation, weighed by its own covariance and by that of one pose relative to the other (eq. 10). Those whose ends
/// lie nearest through the graph are asked first: they are predicted best, and agree least likely by chance. What
/// agrees is taken in and sharpens the prediction of the rest. Poses of the last fit, of trusted and accepted relations
/// alone.
struct ConsistentStart {
  std::vector<Pose2> poses;
  std::vector<bool> accepted;  ///< of each relation; trusted ones are
  bool is_determined = true;   ///< false: trusted relations alone leave poses open, and nothing could be predicted
  double cpu_s = 0;
};
[[nodiscard]] ConsistentStart consistent_start(const RelationGraph& graph, std::span<const std::uint32_t> fixed,
                                               const FitOptions& options);

}  // namespace helicoid
