// summary.json of a map.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/map_outputs.hpp"

namespace helicoid {

/// Every key of the contract. Times are the process's own.
[[nodiscard]] nlohmann::ordered_json summarise(const MapRun& run, const MapReport& report,
                                               const nlohmann::ordered_json& options);

}  // namespace helicoid
