// What the order in which events were heard does to a map: the same events mapped twice.
#pragma once

#include <vector>

#include "helicoid/mapping/mapper.hpp"

namespace helicoid {

struct OrderEffect {
  bool same_islands = false;         ///< the same robots on each
  std::size_t closures_heard = 0;    ///< accepted look-alikes of the map as it was heard
  std::size_t closures_stamped = 0;  ///< and of the map by stamps
  /// The most that the maps disagree about where two places lie to each other that either knows for closed, metres.
  double closures_apart_m = 0;
  /// Closures of either whose places the other map has elsewhere to each other, by more than a hand's breadth (0.10 m)
  /// and by more than it says itself (99 %).
  std::size_t closures_elsewhere = 0;
  double mean_m = 0;  ///< between the poses of one scan in the two maps, each island after one rigid transform
  double farthest_m = 0;
  double mean_deg = 0;
  double farthest_deg = 0;
  std::vector<std::size_t> scans_heard;  ///< by robot: that the map as it was heard has
};

/// Both know the same robots, in the same order. Poses of scans that only one of them has are left out.
[[nodiscard]] OrderEffect compare_orders(const Mapper& heard, const Mapper& stamped);

}  // namespace helicoid
