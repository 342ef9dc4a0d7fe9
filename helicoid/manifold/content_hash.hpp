// One number that stands for everything in a map.
#pragma once

#include <compare>
#include <cstdint>
#include <string>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// 128 bits; not cryptographic: it guards against accidents and shows differences, not against forgers.
struct ContentHash {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  friend auto operator<=>(const ContentHash&, const ContentHash&) = default;
  /// 32 hexadecimal digits.
  [[nodiscard]] std::string hex() const;
};

/// Equal exactly when two maps are equal to the bit: robots, lasers, scans, patches, poses, relations and islands, in
/// their order. What make_patch derives from a scan is not hashed, since it follows. Numbers count by their bits, so
/// that -0 differs from 0 and a NaN equals itself.
[[nodiscard]] ContentHash content_hash(const Map& map);

}  // namespace helicoid
