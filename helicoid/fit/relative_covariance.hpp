// Exact confidence (eq. 9-10): covariances of poses relative to others from the factorised information of the whole
// graph. A few right-hand sides a pair, or selected inversion for all poses at once; never a dense inverse.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/geometry/covariance.hpp"

namespace helicoid {

class LinearSystem;

/// Factorises once, answers many. The answers do not depend on which pose is held. A graph that priors tie to the
/// world is answered without them: they say nothing of one pose relative to another while that one is held.
class RelativeCovariance {
 public:
  /// All poses must be tied together by the edges.
  RelativeCovariance(std::span<const Pose2> poses, std::span<const GraphEdge> edges);
  explicit RelativeCovariance(RelationGraph graph);
  ~RelativeCovariance();

  /// False if the relations leave some pose open: then nothing is known, not "well known".
  [[nodiscard]] bool is_determined() const { return determined_; }
  /// T_a_b with the covariance of its (x, y, yaw) in a's frame; a noise floor of the scans is not included.
  [[nodiscard]] UncertainPose2 of(std::uint32_t a, std::uint32_t b) const;
  /// Of every pose relative to a, in a's frame. Factorises with a held.
  [[nodiscard]] std::vector<UncertainPose2> relative_to(std::uint32_t a);
  /// As factorised last; of two poses at least.
  [[nodiscard]] const LinearSystem& system() const { return *system_; }

 private:
  bool factorise(std::uint32_t held);

  RelationGraph graph_;
  std::unique_ptr<LinearSystem> system_;
  std::uint32_t held_ = 0;
  bool determined_ = false;
};

}  // namespace helicoid
