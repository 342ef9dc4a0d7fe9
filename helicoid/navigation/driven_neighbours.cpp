#include "helicoid/navigation/driven_neighbours.hpp"

#include <algorithm>

namespace helicoid {

namespace {

void insert(std::vector<PatchId>& sorted, PatchId id) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), id);
  if (at == sorted.end() || *at != id) sorted.insert(at, id);
}

}  // namespace

void DrivenNeighbours::read(const Map& map) {
  if (!reader_.follows(map)) *this = {};
  reader_.read_on(map, [&](std::size_t, const TrackedScan& scan, const TrackedScan* before) {
    if (before == nullptr || before->pose.patch == scan.pose.patch) return;
    driven_.push_back(std::minmax(before->pose.patch, scan.pose.patch));
  });
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
