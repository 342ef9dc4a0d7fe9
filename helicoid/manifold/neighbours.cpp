#include "helicoid/manifold/neighbours.hpp"

#include <algorithm>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/manifold/coverage_sweep.hpp"
#include "helicoid/manifold/patch_set.hpp"

namespace helicoid {

namespace {

constexpr double kCell = 0.10;
/// Overlaps are looked for on every third row: one that is 30 cm wide is found.
constexpr int kRowStep = 3;

/// For each patch of an island (by its place) the patches that cover a cell with it.
std::vector<PatchSet> find_overlaps(const Map& map, const Island& island) {
  std::vector<PatchSet> overlaps(island.patches.size(), PatchSet(island.patches.size()));
  PatchSet covering(island.patches.size());
  sweep_coverage(covered_cells(map, island.patches, kCell), kRowStep, [&](const CoveredRun& run) {
    if (run.patches.size() < 2) return;
    covering.clear();
    for (const std::uint32_t place : run.patches) covering.insert(place);
    for (const std::uint32_t place : run.patches) overlaps[place] |= covering;
  });
  return overlaps;
}

/// For each patch of an island (by its place) those known to within eps relative to it (eq. 12).
std::vector<PatchSet> find_confident(const Map& map, const Island& island, const InformationGraph& graph,
                                     const NeighbourOptions& options) {
  std::vector<std::size_t> place(map.patch_count(), 0);
  double reach = 0;
  for (std::size_t i = 0; i < island.patches.size(); ++i) {
    place[island.patches[i].index()] = i;
    reach = std::max(reach, map.patch(island.patches[i]).free_reach);
  }
  std::vector<PatchSet> confident(island.patches.size(), PatchSet(island.patches.size()));
  for (std::size_t i = 0; i < island.patches.size(); ++i) {
    const PatchId id = island.patches[i];
    const BoundOptions bound = bound_options(map.patch(id), options.position, options.heading, 2 * reach);
    for (const BoundedPose& pose : tree_bound(graph, map.poses(), id.value, bound))
      confident[i].insert(place[pose.pose]);
  }
  return confident;
}

}  // namespace

Neighbours find_neighbours(const Map& map, const NeighbourOptions& options) {
  Neighbours neighbours(map.patch_count());
  const InformationGraph graph = information_graph(map);
  for (const Island& island : map.islands()) {
    const std::vector<PatchSet> confident = find_confident(map, island, graph, options);
    std::vector<PatchSet> overlaps = find_overlaps(map, island);
    for (std::size_t i = 0; i < island.patches.size(); ++i) {
      overlaps[i] &= confident[i];
      overlaps[i].for_each([&](std::size_t j) {
        if (j != i && confident[j].contains(i)) neighbours[island.patches[i].index()].push_back(island.patches[j]);
      });
    }
  }
  return neighbours;
}

}  // namespace helicoid
