// Cases of an experiment that read recorded data, which need not be there.
#pragma once

#include "apps/experiment.hpp"

namespace helicoid {

/// Why this path below the data folder cannot be read: to be said aloud by the cases that need it. Empty: it is there.
[[nodiscard]] std::string missing_data(const ExperimentOptions& options, const std::string& path);

}  // namespace helicoid
