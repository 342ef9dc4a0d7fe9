// Helicoid's own tables, and the layers for other programs that are drawn from the same map.
#pragma once

#include <string>

#include "helicoid/manifold/map.hpp"
#include "helicoid/store/database.hpp"

namespace helicoid::store {

/// The statements that make the tables helicoid_map (facts by key), _robots, _lasers, _patches, _relations and
/// _ledger.
[[nodiscard]] std::string own_schema();

/// Fills the layers patches, free_space, relations and trajectories, and gpkg_contents about them.
void write_layers(Database& db, const Map& map);

}  // namespace helicoid::store
