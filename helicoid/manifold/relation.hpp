// Relations tie pairs of patches (eq. 4); all correspondences of a pair are one PairForm.
#pragma once

#include "helicoid/base/ids.hpp"
#include "helicoid/fit/pair_form.hpp"

namespace helicoid {

/// Fixed when the relation is made.
enum class RelationKind : std::uint8_t {
  odometry,  ///< consecutive patches of one robot, by the raw increments between them
  chain,     ///< consecutive patches of one robot, matched
  overlap,   ///< patches that see the same surfaces, within the local map
  closure,   ///< patches that were far apart through the graph
  sighting,  ///< one robot saw another
};
[[nodiscard]] const char* name_of(RelationKind kind);

/// A relation between patches a and b, a < b.
struct Relation {
  PatchId a, b;
  RelationKind kind = RelationKind::overlap;
  PairForm form;            ///< in T_a_b; information as measured, before the laser's kappa is divided out
  Pose2 T_a_b;              ///< at the match
  double c_min = 0;         ///< min v^T M v: every chi^2 test uses the excess over it
  double radius = 0;        ///< how far T_a_b may move before the match must be made again, metres
  int correspondences = 0;  ///< 0 for odometry
};

}  // namespace helicoid
