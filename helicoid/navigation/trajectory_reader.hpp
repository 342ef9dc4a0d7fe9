// Reads trajectories as they grow, each scan once.
#pragma once

#include <vector>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

class TrajectoryReader {
 public:
  /// False if what was read is not what the map holds now (a replay, say): then all is to be read anew.
  [[nodiscard]] bool follows(const Map& map) const;
  /// Calls visit(robot's number, scan, the same robot's scan before it or nullptr) for every scan since the last call,
  /// robot by robot.
  template <class Visit>
  void read_on(const Map& map, const Visit& visit) {
    read_.resize(map.robots().size());
    for (std::size_t i = 0; i < read_.size(); ++i) {
      Read& read = read_[i];
      const Trajectory& trajectory = map.robots()[i].trajectory;
      for (; read.scans < trajectory.size(); ++read.scans) {
        const TrackedScan scan = trajectory[read.scans];
        visit(i, scan, read.scans > 0 ? &read.last : nullptr);
        read.last = scan;
      }
    }
  }

 private:
  /// Up to where a robot's trajectory was read.
  struct Read {
    std::size_t scans = 0;
    TrackedScan last;
  };
  std::vector<Read> read_;
};

}  // namespace helicoid
