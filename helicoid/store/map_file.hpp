// A whole map in one file: `map.gpkg`. An SQLite file that is a valid GeoPackage, with layers that a GIS opens
// (patches, free_space, relations, trajectories) and Helicoid's own tables (helicoid_...) beside them, which hold
// everything that is needed to go on mapping. What make_patch derives is derived again when the map is read.
#pragma once

#include <string>

#include "helicoid/base/result.hpp"
#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// The layout that this version writes and reads.
inline constexpr int kMapSchemaVersion = 2;

/// Writes the map beside `path`, flushes it to the disc and renames it: a reader finds the old file or the new one,
/// never a half. The same map gives the same bytes. Errors: the place cannot be written, the disc is full.
[[nodiscard]] Result<void> write_map(const Map& map, const std::string& path);

/// Reads a map that write_map wrote, equal to the bit (content_hash). Errors: no such file, not an SQLite file, not a
/// GeoPackage, not Helicoid's, a newer schema, damaged content.
[[nodiscard]] Result<Map> read_map(const std::string& path);

}  // namespace helicoid
