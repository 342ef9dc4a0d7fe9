// Which robot looks at which frontier: utility minus travel over the whole team (Burgard et al. 2005; Stachniss 2009),
// the best choice for all together and not first come.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "helicoid/exploration/frontiers.hpp"

namespace helicoid {

struct AssignmentOptions {
  double metres_per_m2 = 0.5;  ///< how far a robot may go for a square metre more
  double most_gain = 12;       ///< what is beyond counts no more: what a look shows at most is not worth any way, m2
  double hysteresis = 1.5;     ///< metres that another goal must be better than the one a robot is going to
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

/// What an assignment is worth, metres: the floor that will be seen, less the ways.
[[nodiscard]] double team_value(std::span<const Frontier> frontiers, const Eigen::MatrixXd& way,
                                std::span<const std::optional<std::size_t>> going_to,
                                std::span<const std::optional<std::size_t>> chosen, const AssignmentOptions& options);

}  // namespace helicoid
