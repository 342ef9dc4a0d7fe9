#include "helicoid/navigation/driven_neighbours.hpp"

#include <algorithm>

namespace helicoid {

namespace {

void insert(std::vector<PatchId>& sorted, PatchId id) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), id);
  if (at == sorted.end() || *at != id) sorted.insert(at, id);
}

}  // namespace

bool DrivenNeighbours::follows(const Map& map) const {
  if (map.robots().size() < readers_.size()) return false;
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    const Reader& reader = readers_[i];
    const Trajectory& trajectory = map.robots()[i].trajectory;
    if (trajectory.size() < reader.scans) return false;
    if (reader.scans > 0 && trajectory[reader.scans - 1].pose != reader.last.pose) return false;
  }
  return true;
}

void DrivenNeighbours::read(const Map& map) {
  if (!follows(map)) *this = {};
  readers_.resize(map.robots().size());
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    Reader& reader = readers_[i];
    const Trajectory& trajectory = map.robots()[i].trajectory;
    for (; reader.scans < trajectory.size(); ++reader.scans) {
      const TrackedScan scan = trajectory[reader.scans];
      const PatchId from = reader.last.pose.patch;
      const PatchId to = scan.pose.patch;
      if (reader.scans > 0 && from != to) driven_.push_back(std::minmax(from, to));
      reader.last = scan;
    }
  }
  std::sort(driven_.begin(), driven_.end());
  driven_.erase(std::unique(driven_.begin(), driven_.end()), driven_.end());
}

Neighbours DrivenNeighbours::add_to(const Map& map, Neighbours neighbours) {
  read(map);
  for (const auto& [a, b] : driven_) {
    // A robot's first scan on another's island may stand on a patch that a merge has yet to bring there.
    if (map.island_of(a) != map.island_of(b)) continue;
    insert(neighbours[a.index()], b);
    insert(neighbours[b.index()], a);
  }
  return neighbours;
}

}  // namespace helicoid
