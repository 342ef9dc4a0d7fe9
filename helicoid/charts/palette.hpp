// The colours of all charts, so that they look like one family.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace helicoid::charts {

/// sRGB, 0xRRGGBB.
using Colour = std::uint32_t;

inline constexpr Colour kUnknown = 0xE3E7EC;  ///< behind everything
inline constexpr Colour kFree = 0xFDFCF8;
inline constexpr Colour kWall = 0x26323E;
inline constexpr Colour kText = 0x3C4856;
inline constexpr Colour kOverlap = 0xE8A33D;  ///< where sheets lie over one another

/// Robots, in their order; tellable apart by the colour-blind (after Okabe and Ito 2008). More robots start again.
inline constexpr std::array<Colour, 7> kRobots{0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0xE69F00, 0x56B4E9, 0x8C6BB1};
/// Free space of islands and sheets in the sketch, in their order: pale.
inline constexpr std::array<Colour, 6> kFloors{0xFDFCF8, 0xFBE9D2, 0xDDEBF6, 0xDFF1E4, 0xF3E1EE, 0xF4F0C9};

[[nodiscard]] constexpr Colour robot_colour(std::size_t robot) {
  return kRobots[robot % kRobots.size()];
}
[[nodiscard]] constexpr Colour floor_colour(std::size_t floor) {
  return kFloors[floor % kFloors.size()];
}
/// One channel: 16 red, 8 green, 0 blue; 0..255.
[[nodiscard]] constexpr int channel(Colour colour, unsigned shift) {
  return static_cast<int>(colour >> shift & 0xFFU);
}

}  // namespace helicoid::charts
