// summary.json of a map.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/map_outputs.hpp"

namespace helicoid {

/// Every key of the contract. Times are the process's own.
[[nodiscard]] nlohmann::ordered_json summarise(const MapRun& run, const MapReport& report,
                                               const nlohmann::ordered_json& options);

/// cpu_s, wall_s and peak_rss_mb.
[[nodiscard]] nlohmann::ordered_json process_figures(double wall_seconds);
/// phase_cpu_s.
[[nodiscard]] nlohmann::ordered_json phase_figures(const PhaseTimes& phase);
/// skipped[].
[[nodiscard]] nlohmann::ordered_json skipped_json(const std::vector<Skipped>& skipped);

}  // namespace helicoid
