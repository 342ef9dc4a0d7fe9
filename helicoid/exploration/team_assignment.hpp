// Which robot looks at which frontier: as much floor for a metre of way as the whole team can get, the best choice for
// all together and not first come (after Burgard et al. 2005 and Stachniss 2009, whose utility is less travel and not
// by it).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "helicoid/exploration/frontiers.hpp"

namespace helicoid {

struct AssignmentOptions {
  double look_m = 1.0;           ///< what a look costs besides its way, braking and turning, as metres driven
  double return_saved_m2 = 3.0;  ///< what a look counts beyond what it shows: what is left must be come back for
  double hysteresis = 1.0;       ///< metres that the way to where a robot is going already counts less
};

/// By robot the frontier that it goes to. `way(r, f)` in metres, infinity where robot r cannot go to f; `going_to`: by
/// robot the frontier that it is on its way to. Frontiers that would show the same floor count once.
[[nodiscard]] std::vector<std::optional<std::size_t>> assign_frontiers(
    std::span<const Frontier> frontiers, const Eigen::MatrixXd& way,
    std::span<const std::optional<std::size_t>> going_to, const AssignmentOptions& options = {});

/// The ways of the robots that are free; infinite for the others.
[[nodiscard]] Eigen::MatrixXd ways_of_free(const Eigen::MatrixXd& way, std::span<const std::uint8_t> is_free);

/// Each robot's nearest frontier, whoever else goes there: what a team does without coordination (Yamauchi 1998).
[[nodiscard]] std::vector<std::optional<std::size_t>> nearest_frontiers(const Eigen::MatrixXd& way);

/// What an assignment gets, summed over robots, m2 a metre: the floor that each will see and the return that it saves,
/// by the way there. Of what two will both see half counts for each.
[[nodiscard]] double team_rate(std::span<const Frontier> frontiers, const Eigen::MatrixXd& way,
                               std::span<const std::optional<std::size_t>> going_to,
                               std::span<const std::optional<std::size_t>> chosen,
                               const AssignmentOptions& options = {});

}  // namespace helicoid
