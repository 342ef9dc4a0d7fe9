// Two buildings as occupancy images, drawn by rule: what a planar mapper would have handed over.
#pragma once

#include "helicoid/simulation/world.hpp"

namespace helicoid {

/// A school: a long corridor that branches, with class rooms on both sides. About 500 m2.
[[nodiscard]] Result<World> drawn_school();
/// A store: one hall full of shelves with aisles between them. About 600 m2.
[[nodiscard]] Result<World> drawn_store();

}  // namespace helicoid
