// Sightings wait until both robots have been placed at their time, and then until they determine how their islands lie.
#pragma once

#include <optional>
#include <vector>

#include "helicoid/mapping/island_join.hpp"

namespace helicoid {

class SightingLog {
 public:
  /// A sighting of a known robot, at the observer's time.
  void add(RobotId observer, RobotId observed, double stamp, const Sighting& sighting);

  /// To be called after every scan: the first pair of islands whose sightings determine how they lie. It is then
  /// forgotten: sightings within one island are not needed. `last`: no more scans will come.
  [[nodiscard]] std::optional<IslandJoin> find_join(const Map& map, bool last = false);

  /// Sightings that are still waiting.
  [[nodiscard]] std::size_t left() const { return waiting_.size() + placed_.size(); }

 private:
  struct Waiting {
    RobotId observer, observed;
    double stamp = 0;
    Sighting sighting;
  };
  void place_waiting(const Map& map, bool last);

  std::vector<Waiting> waiting_;
  std::vector<PlacedSighting> placed_;  ///< each between two islands
  bool fresh_ = false;                  ///< something was placed since the last look
};

/// Where a robot was at a time, between its scans; nothing before its first scan or (unless `last`) after its last.
[[nodiscard]] std::optional<ManifoldPose> place_at(const Map& map, RobotId robot, double stamp, bool last);

}  // namespace helicoid
