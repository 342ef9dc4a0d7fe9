#include "helicoid/navigation/trajectory_reader.hpp"

namespace helicoid {

bool TrajectoryReader::follows(const Map& map) const {
  if (map.robots().size() < read_.size()) return false;
  for (std::size_t i = 0; i < read_.size(); ++i) {
    const Read& read = read_[i];
    if (read.scans == 0) continue;
    const Trajectory& trajectory = map.robots()[i].trajectory;
    if (trajectory.size() < read.scans) return false;
    const TrackedScan last = trajectory[read.scans - 1];
    if (last.stamp != read.last.stamp || last.pose != read.last.pose) return false;
  }
  return true;
}

}  // namespace helicoid
