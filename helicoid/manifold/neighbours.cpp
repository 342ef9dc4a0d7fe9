#include "helicoid/manifold/neighbours.hpp"

#include <algorithm>

#include "helicoid/fit/confident_pairs.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/manifold/coverage_sweep.hpp"
#include "helicoid/manifold/patch_set.hpp"

namespace helicoid {

namespace {

constexpr double kCell = 0.10;
/// Overlaps are looked for on every third row: one that is 30 cm wide is found.
constexpr int kRowStep = 3;

/// Patches of an island (by their places, a < b) that cover a cell together, ascending.
std::vector<PosePair> overlapping_pairs(const Map& map, const Island& island) {
  std::vector<PatchSet> overlaps(island.patches.size(), PatchSet(island.patches.size()));
  PatchSet covering(island.patches.size());
  sweep_coverage(covered_cells(map, island.patches, kCell), kRowStep, [&](const CoveredRun& run) {
    if (run.patches.size() < 2) return;
    covering.clear();
    for (const std::uint32_t place : run.patches) covering.insert(place);
    for (const std::uint32_t place : run.patches) overlaps[place] |= covering;
  });
  std::vector<PosePair> pairs;
  for (std::uint32_t a = 0; a < overlaps.size(); ++a) {
    overlaps[a].for_each([&](std::size_t b) {
      if (b > a) pairs.push_back({a, static_cast<std::uint32_t>(b)});
    });
  }
  return pairs;
}

/// Those of them that are confident relative to each other. Exact: along several ways together a patch may be well
/// known that no single way leads to well enough, as after a loop is closed.
std::vector<PosePair> keep_confident(const Map& map, const Island& island, std::span<const PosePair> pairs,
                                     const NeighbourOptions& options) {
  const std::vector<Pose2> poses = island_poses(map, island);
  const std::vector<GraphEdge> edges = graph_edges(map, island);
  return confident_pairs(poses, RelativeCovariance(poses, edges), pairs, {options.position, options.heading});
}

}  // namespace

Neighbours find_neighbours(const Map& map, const NeighbourOptions& options) {
  Neighbours neighbours(map.patch_count());
  for (const Island& island : map.islands()) {
    for (const auto& [a, b] : keep_confident(map, island, overlapping_pairs(map, island), options)) {
      neighbours[island.patches[a].index()].push_back(island.patches[b]);
      neighbours[island.patches[b].index()].push_back(island.patches[a]);
    }
  }
  for (std::vector<PatchId>& of_patch : neighbours) std::sort(of_patch.begin(), of_patch.end());
  return neighbours;
}

}  // namespace helicoid
