// Where the robots of a team begin.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helicoid/simulation/world.hpp"

namespace helicoid {

struct StartOptions {
  std::size_t robots = 1;
  std::uint64_t seed = 1;
  double radius = 0.20;         ///< of a robot, metres
  std::size_t group = 2;        ///< fewer robots than two groups of so many begin together
  double spacing = 1.5;         ///< between the robots of a group, where there is room; metres
  double comfortable = 0.5;     ///< kept from walls, where there is room; metres
  double farthest_share = 0.6;  ///< how far apart groups begin at least, of the longest way that there is
};

/// Places on the floor that can be reached from the world's own starts (or, without any, on its largest closed space):
/// in two groups far from one another, whose robots see their group's first. Errors: no room for so many.
[[nodiscard]] Result<std::vector<Pose2>> place_starts(const World& world, const StartOptions& options);

/// One start a line: x and y in metres, the heading in degrees anticlockwise; `#` begins a comment. `name` is what
/// messages call the text.
[[nodiscard]] Result<std::vector<Pose2>> parse_starts(const std::string& text, const std::string& name);

/// What `--starts` says: "auto" (place_starts), a file (parse_starts), or nothing: the world's own if it has enough,
/// else as "auto". Exactly as many as there are robots. Errors: a file that cannot be read or names too few.
[[nodiscard]] Result<std::vector<Pose2>> choose_starts(const World& world, const std::string& choice,
                                                       const StartOptions& options);

}  // namespace helicoid
