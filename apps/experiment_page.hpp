// What an experiment's report looks like: for scripts, for a terminal, and as a page with pictures.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/experiment.hpp"

namespace helicoid {

/// The object of the contract: runs[], metrics{} and whether all bars were passed.
[[nodiscard]] nlohmann::ordered_json to_json(const Experiment& experiment, const ExperimentOptions& options,
                                             const ExperimentReport& report);
/// A line for every metric of every case.
[[nodiscard]] std::string to_table(const ExperimentReport& report);
/// "at most 1", "0.5 to 2, the mean"; empty without a bar.
[[nodiscard]] std::string describe(const Bar* bar);

/// Writes NAME.md, the runs' pictures and NAME.svg (all values against their bars) into `folder`. Error: it cannot be
/// written.
[[nodiscard]] Result<void> write_experiment_page(const Experiment& experiment, const ExperimentOptions& options,
                                                 const ExperimentReport& report, const std::string& folder);

}  // namespace helicoid
