// The picture of a simulated world: its walls, its routes and where the robots truly went.
#pragma once

#include <span>
#include <string>

#include "helicoid/simulation/true_relations.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

/// Two places in the world and what is to be said of them, in a word or two.
struct WorldNote {
  Vector2d p_world_a, p_world_b;
  std::string text;
};

/// As SVG, north (y) up, with a scale bar.
[[nodiscard]] std::string draw_world(const World& world, std::span<const TrueTrack> tracks,
                                     std::span<const WorldNote> notes = {});

}  // namespace helicoid
