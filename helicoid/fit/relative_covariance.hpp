// Exact confidence (eq. 9-10): the covariance of one pose relative to another from the factorised information of the
// whole graph. A few right-hand sides a pair; never a dense inverse.
#pragma once

#include <memory>
#include <span>

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/geometry/covariance.hpp"

namespace helicoid {

class NormalEquations;

/// Factorises once, answers many. The answers do not depend on which pose is held.
class RelativeCovariance {
 public:
  /// All poses must be tied together by the edges.
  RelativeCovariance(std::span<const Pose2> poses, std::span<const GraphEdge> edges);
  ~RelativeCovariance();

  /// False if the relations leave some pose open: then nothing is known, not "well known".
  [[nodiscard]] bool is_determined() const { return determined_; }
  /// T_a_b with the covariance of its (x, y, yaw) in a's frame; a noise floor of the scans is not included.
  [[nodiscard]] UncertainPose2 of(std::uint32_t a, std::uint32_t b) const;

 private:
  std::vector<Pose2> poses_;
  std::unique_ptr<NormalEquations> equations_;
  bool determined_ = false;
};

}  // namespace helicoid
