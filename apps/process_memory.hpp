// What a map and a process hold in memory.
#pragma once

#include <cstddef>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// Bytes of patches, relations and poses, the spare room of their lists included.
[[nodiscard]] std::size_t map_bytes(const Map& map);
/// Bytes of the record of where each scan was taken, which is an output and grows with every scan.
[[nodiscard]] std::size_t trajectory_bytes(const Map& map);
/// The process's resident set, bytes; 0 where /proc is not to be had.
[[nodiscard]] std::size_t resident_bytes();

}  // namespace helicoid
