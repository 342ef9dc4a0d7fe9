// Two islands laid over one another: do they contradict each other where both have been (design 5.6)?
#pragma once

#include <span>

#include "helicoid/mapping/local_map.hpp"

namespace helicoid {

/// Places, half a metre wide, at which something stood and that were looked at once more.
struct SecondLook {
  std::size_t places = 0;
  std::size_t gone = 0;  ///< at which it stood no longer: what is seen there lies behind it
  [[nodiscard]] double share() const {
    return places > 0 ? static_cast<double>(gone) / static_cast<double>(places) : 0;
  }
};

struct IslandOverlay {
  SecondLook within;   ///< by robots of the same island
  SecondLook between;  ///< by those of the other
};

struct IslandOverlayOptions {
  double passage = 8;       ///< what one robot saw within so much of its way is one look, metres
  double place = 0.5;       ///< metres
  double surface = 0.15;    ///< a beam that ends so near a point sees it, metres
  double deep = 0.35;       ///< one that ends so far behind it sees through it, metres
  std::size_t points = 3;   ///< of a place, and the larger part of them, that must be seen through
  double by_chance = 0.01;  ///< see is_contradicted
};

/// What the patches of two islands that were joined say of each other's ground, as far as the joined map is sure how
/// they lie (eq. 12). Only what stood still counts: what one other scan of the same passage saw again and none saw
/// through. `apart`: the map before they were joined; `along`: how far along its robot's way each patch was kept,
/// metres.
[[nodiscard]] IslandOverlay lay_over(const Map& joined, const InformationGraph& graph, const Map& apart,
                                     IslandId joined_island, std::span<const double> along, const MapperOptions& mapper,
                                     const IslandOverlayOptions& options = {});

/// True if the islands contradict each other at more places than chance explains, were they to change and to be
/// mistaken as often between as within: doors, chairs and scans' errors are in both. One more is added to those within,
/// so that islands which never contradict themselves are not taken to be without error.
[[nodiscard]] bool is_contradicted(const IslandOverlay& overlay, const IslandOverlayOptions& options = {});

}  // namespace helicoid
