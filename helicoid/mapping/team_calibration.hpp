// What a fit says of the robots that were fitted: how they follow commands, and how well they see.
#pragma once

#include <span>

#include "helicoid/mapping/team_graph.hpp"

namespace helicoid {

/// Gains and delay of each robot by least squares between what it was told and the fitted motion.
[[nodiscard]] std::vector<OdometryModel> fit_gains(const TeamLog& log, const TeamNodes& nodes,
                                                   std::span<const Pose2> poses,
                                                   const std::vector<OdometryModel>& before);

/// Relations whose detection is farther off, in sigmas of range and bearing, than any right one: by relation.
[[nodiscard]] std::vector<bool> find_wrong(const TeamLog& log, const TeamGraph& team, const TeamModel& model,
                                           double gate);

/// Variances that explain the residuals of a fitted graph without wrong detections. Along the way by variance
/// components (Foerstner 1979): squared residuals over their redundancy, the share that the fit has not used up;
/// turning and detections by expectation: squared residuals and what the fit does not know (Dempster, Laird and Rubin
/// 1977). As it was where the graph leaves a pose open.
[[nodiscard]] TeamModel fit_variances(const TeamLog& log, const TeamNodes& nodes, const TeamGraph& team,
                                      const TeamModel& before);

}  // namespace helicoid
