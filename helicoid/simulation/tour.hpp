// A route for a world that brings none: a tour that looks into every part of the building.
#pragma once

#include "helicoid/simulation/world.hpp"

namespace helicoid {

struct TourOptions {
  double cell = 0.1;         ///< of the raster that the tour is planned on, metres
  double clearance = 0.40;   ///< kept from walls, metres
  double comfortable = 0.9;  ///< where there is room, metres
  double spacing = 3.0;      ///< between places that the tour visits, metres
  std::size_t most_places = 80;
  std::size_t most_cells = 4'000'000;  ///< larger worlds are refused
};

/// A closed route from the world's first start (or, without one, in its largest closed space) round through all that a
/// robot can reach. Error: no room for a robot, a world too large for the raster.
[[nodiscard]] Result<Route> plan_tour(const World& world, const TourOptions& options = {});

}  // namespace helicoid
