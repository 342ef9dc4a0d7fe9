// Whatever a laser file holds, it is refused with a message or gives a laser whose numbers can be worked with.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "helicoid/io/laser_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  const Result<LaserModel> laser =
      parse_laser(std::string(reinterpret_cast<const char*>(data), size), "fuzz", LaserModel{});
  if (!laser && laser.error().message.empty()) std::abort();
  if (laser && !(std::isfinite(laser->max_range) && laser->range_sigma > 0 && laser->kappa > 0)) std::abort();
  return 0;
}
