// A fit together with the choice of where to begin, and what can be said of the optimum.
#pragma once

#include "helicoid/fit/fit_graph.hpp"

namespace helicoid {

enum class FitStart : std::uint8_t {
  given,     ///< graph.poses
  odometry,  ///< dead reckoning
  chordal,
  automatic,  ///< as given; where that meets trouble or ends in an implausible optimum, chordal, and the better of both
};

struct StartedFit {
  FitResult result;
  FitStart start = FitStart::given;     ///< the one that led there
  std::int64_t degrees_of_freedom = 0;  ///< residuals less unknowns
  std::size_t wrong_relations = 0;      ///< that a truncated loss let go
  /// Not a certificate of the global optimum, but what the data can say: chi^2 at the optimum is no larger than noise
  /// as stated makes it in 99.9 % of cases. False: the optimum may be local, or relations contradict each other.
  bool is_plausible = false;
};

/// `held` nodes stay where `graph` has them; of a component that has none the first pose is held, as by `fit`.
[[nodiscard]] StartedFit fit_from(const RelationGraph& graph, FitStart start, const FitOptions& options = {},
                                  std::span<const std::uint32_t> held = {});

}  // namespace helicoid
