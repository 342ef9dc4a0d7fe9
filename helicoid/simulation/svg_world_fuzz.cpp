// Whatever an SVG holds, it is refused with a message or becomes a world in which rays can be cast.
#include <cstdint>
#include <cstdlib>

#include "helicoid/simulation/world.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  const Result<World> world = parse_svg_world(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  if (!world) return world.error().message.empty() ? std::abort(), 0 : 0;
  const RayCaster walls(world->walls);
  (void)walls.cast(world->walls.front().from + Vector2d(0.1, 0.2), {0.6, 0.8}, 80);
  (void)walls.clearance({0, 0}, 1);
  return 0;
}
