// Which accepted entries of a simulated run's ledger are false.
#pragma once

#include "apps/simulated_run.hpp"

namespace helicoid {

/// An entry is false if it is off by more than this (either) and by more than it says itself.
inline constexpr double kFalseBy = 0.5;       // metres
inline constexpr double kFalseByTurn = 0.15;  // radians

[[nodiscard]] bool is_false(const SimulatedRun& run, const Hypothesis& h);

}  // namespace helicoid
