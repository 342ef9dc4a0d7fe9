// Grey images in the forms in which occupancy grids come: PGM and PNG.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"

namespace helicoid {

/// Grey values from black to white, row 0 at the top.
struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

/// The grey that ROS's map_server gives to what is unknown.
inline constexpr std::uint8_t kUnknownGrey = 205;

/// PGM in binary or in words, with any number of grey levels, or PNG; what is transparent is unknown. `name` is what
/// messages call it.
[[nodiscard]] Result<GreyImage> read_grey_image(const std::string& bytes, const std::string& name);

}  // namespace helicoid
