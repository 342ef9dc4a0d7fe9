// Islands that evidence would join are joined on trial: a few places that look alike may lie on another floor of the
// same plan, and only all the ground that both islands know can tell (design 5.6).
#pragma once

#include <string>

#include "helicoid/mapping/close_loops.hpp"

namespace helicoid {

/// Joins the two islands of entries that were accepted together, and closes what loops that makes.
void join_by_entries(MapInProgress& progress, LoopCloser& closer, std::span<const std::size_t> accepted,
                     const MapperOptions& mapper);

class JoinTrials {
 public:
  /// Joins the two islands of entries that were accepted together, and closes what loops that makes. If the islands, so
  /// joined, contradict each other, all is as it was and the entries are left open. True if they were joined.
  bool join_if_it_holds(MapInProgress& progress, LoopCloser& closer, std::span<const std::size_t> accepted,
                        const MapperOptions& mapper);

 private:
  /// A join that did not hold: how it laid the islands over one another, and what spoke against it.
  struct Refused {
    std::vector<Pose2> T_plane_patch;
    std::string reason;
    [[nodiscard]] bool is_of(const Hypothesis& h) const;
  };
  /// By these, other entries need not be tried again that come to the same.
  std::vector<Refused> refused_;
};

}  // namespace helicoid
