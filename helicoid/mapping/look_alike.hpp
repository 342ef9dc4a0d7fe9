// Finds the places of the map that a patch may show again (paper IV-B; design 5.6).
#pragma once

#include <optional>

#include "helicoid/mapping/ledger.hpp"
#include "helicoid/mapping/local_map.hpp"
#include "helicoid/mapping/mapper_options.hpp"

namespace helicoid {

struct LookAlikeOptions {
  double narrow = 0.8;         ///< if the map knows it this well (eq. 10), the match starts from there, metres
  double narrow_reach = 4;     ///< and is compared with what lies so far off, metres
  double widest = 20;          ///< windows are never wider, metres
  double widest_turn = 0.7;    ///< radians
  double sigmas = 3;           ///< the window's half-width, in standard deviations
  double drift_inflation = 2;  ///< of the stated deviations: drift is not all random
  double place_reach = 5;      ///< the way whose patches make up the place, metres
  std::size_t place_patches = 5;
  std::size_t views = 8;   ///< patches about the candidate that it is compared with
  double wide = 3;         ///< a window of this half-width is searched near its middle first, metres
  double wide_reach = 12;  ///< and what lies so far about the candidate is compared, metres
  std::size_t wide_views = 20;
  double far_more =
      1.5;  ///< what lies at the edge of such a window is believed first if it has this many times the merit
  std::size_t candidates = 4;
  double least_search_score = 0.6;
  double least_score = 0.62;  ///< inlier share of an alignment
  double most_contradicted = 0.12;
  double foretold = 0.5;  ///< if the map knows it this well (eq. 10) and the match agrees, one is enough, metres
  double least_score_near = 0.4;         ///< where the map knows it well, part of a place is enough,
  double least_part = 150;               ///< if it has so many points
  double most_contradicted_part = 0.02;  ///< and next to nothing speaks against it
};

/// What was seen about b, in b's frame.
struct PlaceBefore {
  PatchId b;
  std::vector<LocalPatch> views;  ///< b and what its robot kept on the last few metres before it
  ScanPoints points;              ///< of what stood still meanwhile
};
[[nodiscard]] PlaceBefore see_place(const Map& map, PatchId b, const LookAlikeOptions& options);

/// A patch that may show the same place, and where.
struct Candidate {
  PatchId a;
  UncertainPose2 T_a_b;  ///< as the map has it, and an upper bound of its covariance
};

/// The patches that may lie where `b` does without the map being sure: nearest first, one a place. `known` are those
/// that it is sure about. `bounds`: all possible candidates relative to b, others may be there.
[[nodiscard]] std::vector<Candidate> find_candidates(const Map& map, const InformationGraph& graph, PatchId b,
                                                     std::span<const BoundedPose> bounds, const LocalMap& known,
                                                     const LookAlikeOptions& options);

/// No candidate lies farther off in the plane, metres.
[[nodiscard]] double farthest_candidate(const LookAlikeOptions& options);

/// The patches among which candidates are found: older ones that lie near enough and are not known.
[[nodiscard]] std::vector<PatchId> possible_candidates(const Map& map, PatchId b, const LocalMap& known,
                                                       const LookAlikeOptions& options);

/// Aligns what was seen about a place with what was seen about a, over the whole window. Nothing if they do not fit.
/// Its reason: what rules out the second-best placement, in words; empty if nothing stands out.
[[nodiscard]] std::optional<Hypothesis> compare_places(const Map& map, const InformationGraph& graph,
                                                       const Candidate& candidate, const PlaceBefore& place,
                                                       const MapperOptions& mapper, const LookAlikeOptions& options);

/// What speaks for an entry, less what speaks against it: 0..1.
[[nodiscard]] double merit_of(const Hypothesis& h, const LookAlikeOptions& options);

}  // namespace helicoid
