// A map's patches and relations as a g2o pose graph.
#pragma once

#include <string>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// VERTEX_SE2 a patch (id = patch id) and EDGE_SE2 a relation, at its own minimum, with its honest information (divided
/// by kappa); the first patch of each island is FIXed.
[[nodiscard]] std::string to_g2o(const Map& map);

}  // namespace helicoid
