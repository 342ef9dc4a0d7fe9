// Whatever a MAP.yaml and its image hold, they are refused with a message or become a world in which rays can be cast.
// The input is the YAML text, a zero byte, and the image.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "helicoid/simulation/world.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  const std::string all(reinterpret_cast<const char*>(data), size);
  const std::size_t zero = std::min(all.find('\0'), size);
  const Result<World> world = parse_image_world(all.substr(0, zero), all.substr(std::min(zero + 1, size)), "fuzz.yaml");
  if (!world) return world.error().message.empty() ? std::abort(), 0 : 0;
  const RayCaster walls(world->walls);
  (void)walls.cast(world->walls.front().from + Vector2d(0.1, 0.2), {0.6, 0.8}, 80);
  (void)walls.clearance({0, 0}, 1);
  return 0;
}
