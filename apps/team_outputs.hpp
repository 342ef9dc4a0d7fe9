// What `map` writes of a team without lasers.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/team_run.hpp"
#include "helicoid/io/graph_reader.hpp"

namespace helicoid {

/// A team's graph at these poses as g2o can have it.
[[nodiscard]] GraphFile team_graph_file(const RelationGraph& graph, std::vector<Pose2> poses);

/// trajectories/ROBOT.tum and graph.g2o, the latter in the islands' frames.
[[nodiscard]] Result<void> write_team_records(const TeamRun& run, const std::string& folder);

/// The robots' ways and the landmarks of the islands, one chart each, as SVG.
[[nodiscard]] std::string draw_team(const TeamRun& run);

/// summary.json.
[[nodiscard]] nlohmann::ordered_json summarise_team(const TeamRun& run, const std::string& folder,
                                                    const nlohmann::ordered_json& options);

}  // namespace helicoid
