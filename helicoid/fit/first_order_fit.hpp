// The paper's simpler methods (III-C): gradient descent and Fletcher-Reeves, preconditioned by the blocks of the
// information's diagonal, without which metres and radians would not mix.
#pragma once

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/fit/linear_system.hpp"

namespace helicoid {

/// Minimises from result.poses on; fills the result. `options.method` is Fletcher-Reeves or gradient descent.
void descend(LinearSystem& system, const FitOptions& options, FitResult& result);

}  // namespace helicoid
