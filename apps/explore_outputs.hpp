// What `explore` writes (contract: *helicoid explore*).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/explore_run.hpp"

namespace helicoid {

struct ExploreOutput {
  std::string folder;
  nlohmann::ordered_json options;
  bool charts = true;
  int threads = 1;
};

struct ExploreFiles {
  nlohmann::ordered_json summary;
  std::vector<std::string> pictures;
};

/// What `map` writes, the logs, the truth, events.json, and a summary with what the building says of it.
[[nodiscard]] Result<ExploreFiles> write_exploration(ExploreRun& run, const ExploreJob& job,
                                                     const ExploreOutput& output);

}  // namespace helicoid
