// Matches that no longer hold are made again, where their patches have come to lie (design 5.5).
#pragma once

#include <cstddef>

#include "helicoid/manifold/map_editor.hpp"

namespace helicoid {

/// A match holds about where it was made: between thick walls' two faces, or frames of a door, other points answer to
/// one another a few centimetres on. Pairs that fits have moved since by more than their relation's radius are matched
/// again and all islands fitted, until none has moved so far, or for a few rounds. A pair that does not match where it
/// lies now keeps what it had. The number of matches that were made.
std::size_t match_again(const Map& map, MapEditor& editor);

}  // namespace helicoid
