// A map's folder as a later verb finds it.
#pragma once

#include <string>
#include <vector>

#include "apps/map_command.hpp"
#include "helicoid/base/result.hpp"

namespace helicoid {

/// The folder of a map that was named by its folder or by its map.gpkg.
[[nodiscard]] std::string map_folder(const std::string& map);

/// The command line that made the map, `out` left empty. `named` (NAME=LOG[,LOG...]) says where robots' logs are now.
/// Errors: there is no summary.json or it is none, it was made from stdin, a log is not there.
[[nodiscard]] Result<MapArguments> arguments_of_map(const std::string& folder, const std::vector<std::string>& named);

}  // namespace helicoid
