// The maximum likelihood fit (paper III-C) at the cost of what it moves.
#pragma once

#include <span>
#include <vector>

#include "helicoid/manifold/map_editor.hpp"

namespace helicoid {

/// What fit_islands does, where only some patches were newly related in a map that was fitted before: the fit goes out
/// from them as far as it moves anything, what lies beyond is held. An island of up to a thousand patches is fitted
/// whole, its first patch the gauge. The patches that were fitted, ascending.
std::vector<PatchId> fit_around(const Map& map, MapEditor& editor, std::span<const PatchId> related);

}  // namespace helicoid
