// The maximum likelihood fit of everything (paper III-C): island by island, from the poses as they are.
#pragma once

#include "helicoid/manifold/map_editor.hpp"

namespace helicoid {

/// The gauge is each island's first patch.
void fit_islands(const Map& map, MapEditor& editor);

/// Moves each island as a whole so that the first pose of its alphabetically first robot is its plane's origin: the
/// frame in which people meet it, whichever robot's island the others were joined to.
void choose_origins(const Map& map, MapEditor& editor);

}  // namespace helicoid
