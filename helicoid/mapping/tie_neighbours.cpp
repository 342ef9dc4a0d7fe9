#include "helicoid/mapping/tie_neighbours.hpp"

#include <algorithm>

#include "helicoid/align/align_scan.hpp"
#include "helicoid/fit/confident_pairs.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/fit_islands.hpp"

namespace helicoid {

namespace {

/// Patches that another is tied to at once.
constexpr std::size_t kViews = 4;

/// Pairs that lie near each other (by their places in the island, the older one first) where no relation ties the
/// younger one to the older one's stretch of way.
std::vector<PosePair> untied_pairs(const Map& map, const Island& island, std::span<const double> along) {
  std::vector<PosePair> pairs;
  for (std::uint32_t b = 0; b < island.patches.size(); ++b) {
    for (const PatchId a : older_patches_about(map, island.patches[b])) {
      if (is_untied_ground(map, island.patches[b], a, along)) pairs.push_back({island.place_of(a), b});
    }
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const PosePair& p, const PosePair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
  return pairs;
}

/// For every patch of the island the older ones that it is confident of, but not tied to.
std::vector<LocalMap> find_untied(const Map& map, const Island& island, std::span<const double> along,
                                  const MapperOptions& options) {
  std::vector<LocalMap> untied(island.patches.size());
  const std::vector<PosePair> pairs = untied_pairs(map, island, along);
  if (pairs.empty()) return untied;
  const std::vector<Pose2> poses = island_poses(map, island);
  const std::vector<GraphEdge> edges = graph_edges(map, island);
  const PairLimits limits{options.reference_position, options.reference_heading};
  for (const auto& [a, b] : confident_pairs(poses, RelativeCovariance(poses, edges), pairs, limits)) {
    untied[b].push_back({island.patches[a], poses[b].inverse() * poses[a]});
  }
  return untied;
}

/// Confident means to 15 cm: from there the patch is aligned first, since correspondences of a pair reach less far.
bool tie_patch(MapInProgress& progress, PatchId b, const LocalMap& known) {
  const Map& map = progress.map;
  const Patch& patch = map.patch(b);
  const std::vector<LocalPatch> views = select_views(map, known, patch.points, Pose2{}, PatchId{}, kViews);
  Reference reference;
  reference.build(reference_parts(map, views));
  const Matrix3d open = Vector3d(1e2, 1e2, 1e3).asDiagonal();
  const Alignment found = align_scan(reference, patch.points, {Pose2{}, open}, align_options(patch.laser));
  if (!found.usable()) return false;
  return !relate_to(progress, b, views, {found.T_reference_scan, open}, RelationKind::overlap).relations.empty();
}

int tie_island(MapInProgress& progress, const Island& island, std::span<const double> along,
               const MapperOptions& options) {
  std::vector<LocalMap> untied = find_untied(progress.map, island, along, options);
  int tied = 0;
  for (std::size_t b = 0; b < untied.size(); ++b) {
    const PatchId id = island.patches[b];
    std::erase_if(untied[b], [&](const LocalPatch& p) { return is_tied_to_stretch(progress.map, id, p.patch, along); });
    if (!untied[b].empty() && tie_patch(progress, id, untied[b])) ++tied;
  }
  return tied;
}

}  // namespace

void tie_neighbours(MapInProgress& progress, std::span<const double> along, const MapperOptions& options) {
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    int tied = 0;
    for (const Island& island : progress.map.islands()) tied += tie_island(progress, island, along, options);
    if (tied == 0) return;
    fit_islands(progress.map, progress.editor);
  }
}

}  // namespace helicoid
