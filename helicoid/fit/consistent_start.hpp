// A start for robust fits that wrong relations cannot pull away: from what is trusted to what agrees with it.
#pragma once

#include <span>
#include <vector>

#include "helicoid/fit/fit_graph.hpp"

namespace helicoid {

/// Relations that may be wrong are asked round by round whether they agree with the poses so far, by their innovation.
/// Those that are predicted best are asked first, since they agree least likely by chance; what agrees is taken in and
/// sharpens the prediction of the rest. In the end no relation is left whose change of sides would lower the truncated
/// cost: what the others contradict is let go, what agrees with them is taken in (to first order).
struct ConsistentStart {
  std::vector<Pose2> poses;    ///< of the fit of trusted and accepted relations alone
  std::vector<bool> accepted;  ///< of each relation; trusted ones are
  bool is_determined = true;   ///< false: trusted relations alone leave poses open, and nothing could be predicted
  double gate = 0;             ///< of the innovation's chi^2, in the end
  double cpu_s = 0;
};

/// One relation alone is asked at the loss's own width. The gate of the end is as wide that of so many right relations
/// none is let go in 999 graphs of 1000 (a single one may be all that holds a long chain in place, while a wrong one
/// that agrees so well does little harm), and shrinks with the noise that is found.
[[nodiscard]] ConsistentStart consistent_start(const RelationGraph& graph, std::span<const std::uint32_t> fixed,
                                               const FitOptions& options);

/// The chi^2 with 3 degrees of freedom that is exceeded with this probability.
[[nodiscard]] double chi_square_quantile(double exceedance);

}  // namespace helicoid
