// A campus for the experiment of that name: buildings that robots mapped, and as many copies of them as are wanted.
#pragma once

#include <string>
#include <vector>

#include "apps/simulated_run.hpp"

namespace helicoid {

struct CampusSize {
  std::size_t buildings;            ///< mapped whole, one robot each
  std::vector<double> rings;        ///< perimeters of loop corridors, one robot each, metres
  std::vector<std::size_t> around;  ///< patches of the maps in which scans are timed
};

/// A building as its robot mapped it on its first lap, and the robot, which can go on.
struct MappedBuilding {
  Simulator simulator;
  SimulatedEvent next;  ///< the first of the second lap
  Map map;
};

struct Campus {
  std::vector<MappedBuilding> buildings;
  std::vector<MappedBuilding> rings;  ///< their loops are open yet
};

/// Simulates and maps all that is mapped whole. Error: a world that cannot be driven.
[[nodiscard]] Result<Campus> map_campus(const CampusSize& size);

/// The mapped buildings, and copies of them until there are so many patches, as one island.
[[nodiscard]] Map build_campus(const Campus& campus, std::size_t patches);

/// Of the robot that mapped the i-th ring, or the i-th building, in the campus.
[[nodiscard]] std::string ring_robot(std::size_t i);
[[nodiscard]] std::string building_robot(std::size_t i);

}  // namespace helicoid
