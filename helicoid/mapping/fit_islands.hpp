// The maximum likelihood fit of everything (paper III-C): island by island, from the poses as they are.
#pragma once

#include "helicoid/manifold/map_editor.hpp"

namespace helicoid {

/// The gauge is each island's first patch.
void fit_islands(const Map& map, MapEditor& editor);

}  // namespace helicoid
