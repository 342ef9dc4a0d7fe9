// The picture of a simulated world: its walls, its routes and where the robots truly went.
#pragma once

#include <span>
#include <string>

#include "helicoid/simulation/true_relations.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

/// As SVG, north (y) up, with a scale bar.
[[nodiscard]] std::string draw_world(const World& world, std::span<const TrueTrack> tracks);

}  // namespace helicoid
