// What a relation says beside what all the others say: the innovation of estimation theory, for relations that are part
// of a fit and for those that are not.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "helicoid/fit/fit_graph.hpp"

namespace helicoid {

class LinearSystem;

/// How well a relation agrees with the others, and how much that tells.
struct Innovation {
  double chi2 = 0;        ///< what it adds to the least chi^2 of all others together
  double log_volume = 0;  ///< ln det of the innovation's covariance: the larger, the more easily chance agrees, too
};

/// Some relations of a graph fitted and factorised.
class FittedPart {
 public:
  /// Of `graph` the `taken` relations, fitted from `start` on by least squares.
  FittedPart(const RelationGraph& graph, const std::vector<bool>& taken, std::span<const Pose2> start,
             std::span<const std::uint32_t> fixed, const FitOptions& options);
  ~FittedPart();
  FittedPart(const FittedPart&) = delete;
  FittedPart& operator=(const FittedPart&) = delete;

  /// False: the taken relations leave some pose open, and nothing is predicted.
  [[nodiscard]] bool is_determined() const { return system_ != nullptr; }
  [[nodiscard]] const RelationGraph& graph() const { return part_; }
  [[nodiscard]] const std::vector<Pose2>& poses() const { return part_.poses; }
  [[nodiscard]] double cost() const { return cost_; }  ///< chi^2 / 2
  /// chi^2 over its degrees of freedom: how much larger noise is than stated, as a factor of variances. 1 where there
  /// is too little to tell.
  [[nodiscard]] double variance_factor() const { return variance_factor_; }
  /// Of a relation that is not taken: weighed by its own covariance and that of the prediction, S = R + P. Of one that
  /// is: what leaving it out would gain (S = R - P); 0 where nothing else holds its ends. Linearised at the fit.
  [[nodiscard]] Innovation innovation(const GraphRelation& relation, bool is_taken) const;

 private:
  RelationGraph part_;
  std::unique_ptr<LinearSystem> system_;
  double cost_ = 0;
  double variance_factor_ = 1;
};

}  // namespace helicoid
