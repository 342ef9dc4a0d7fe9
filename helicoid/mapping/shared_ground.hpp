// What the patches about two places say of each other, once it is supposed how the places lie: the test of every
// statement that comes from elsewhere than the scans.
#pragma once

#include "helicoid/mapping/map_in_progress.hpp"

namespace helicoid {

enum class Verdict : std::uint8_t { silent, confirmed, contradicted };

struct SharedGround {
  int agreeing = 0;  ///< correspondences
  int against = 0;   ///< points of one view that lie deep in what another saw as free
  Verdict verdict = Verdict::silent;
  [[nodiscard]] double share() const { return agreeing + against > 0 ? agreeing / double(agreeing + against) : 0; }
};

/// A place and the robots whose patches about it are asked; none: all of its island. Once two islands are joined, those
/// that were on one side, or the map would be found to agree with itself.
struct Ground {
  ManifoldPose place;
  std::span<const RobotId> robots;
};

struct SharedGroundOptions {
  double reach = 4;         ///< about either place, metres
  double most_apart = 8;    ///< two patches that are compared, metres
  std::size_t patches = 6;  ///< of either place at most, the nearest
  int least_majority = 50;  ///< points; less is no evidence
  double deep = 0.35;       ///< across the surface on which a point lies, metres
};

/// Compares the patches about p, as far as the map is sure of them there (eq. 12), with those about q; `T_p_q` relates
/// the two places. Each pair may move within the covariance to where it fits best.
[[nodiscard]] SharedGround compare_ground(const Map& map, const InformationGraph& graph, const Ground& p,
                                          const Ground& q, const UncertainPose2& T_p_q,
                                          const SharedGroundOptions& options = {});

/// The robots that made patches of an island, ascending.
[[nodiscard]] std::vector<RobotId> robots_on(const Map& map, IslandId island);

}  // namespace helicoid
