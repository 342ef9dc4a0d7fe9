// Where landmarks stand by what saw them, some of it wrong.
#pragma once

#include <span>
#include <vector>

#include "helicoid/mapping/team_graph.hpp"

namespace helicoid {

/// Of these places, at least one, the one that is nearest to all others: wrong ones do not move it far.
[[nodiscard]] Vector2d medoid(std::span<const Vector2d> places);

/// The poses with each landmark put where most of those who see it have it, if most of its detections are wrong where
/// it stands: no fit leads it there, since wrong detections do not pull. `wrong`: by relation.
[[nodiscard]] std::vector<Pose2> reseat_landmarks(const TeamGraph& team, const std::vector<bool>& wrong);

}  // namespace helicoid
