// Which accepted entries of a simulated run's ledger are false.
#pragma once

#include "apps/simulated_run.hpp"

namespace helicoid {

/// An entry is false if it is off by more than this (either) and by more than it says itself.
inline constexpr double kFalseBy = 0.5;         // metres
inline constexpr double kFalseByTurn = 0.15;    // radians
inline constexpr double kFalseByChi2 = 11.345;  // 99 % at three degrees of freedom

/// True if a relative pose is off by more than it says itself (99 %).
[[nodiscard]] bool is_beyond_said(const UncertainPose2& said, const Pose2& truth);

[[nodiscard]] bool is_false(const SimulatedRun& run, const Hypothesis& h);

}  // namespace helicoid
