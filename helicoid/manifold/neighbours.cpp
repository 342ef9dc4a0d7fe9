#include "helicoid/manifold/neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

namespace {

constexpr int kSampleBeams = 16;
constexpr double kShares[] = {0.9, 0.6, 0.3};

/// Samples of b's free space that lie in a's.
bool has_sample_inside(const Patch& a, const Patch& b, const Pose2& T_a_b) {
  const Pose2 T_a_laser = T_a_b * b.scan.T_robot_laser;
  const int stride = std::max(1, b.laser.beams / kSampleBeams);
  for (const double share : kShares) {
    for (int beam = stride / 2; beam < b.laser.beams; beam += stride) {
      const double range = share * static_cast<double>(b.free_ranges[beam]);
      if (range <= 0) continue;
      const double bearing = b.laser.bearing(beam);
      if (contains(a, T_a_laser * Vector2d(range * std::cos(bearing), range * std::sin(bearing)))) return true;
    }
  }
  return false;
}

bool contains_id(const std::vector<PatchId>& sorted, PatchId id) {
  return std::binary_search(sorted.begin(), sorted.end(), id);
}

}  // namespace

bool free_space_overlaps(const Patch& a, const Patch& b, const Pose2& T_a_b) {
  const double distance = T_a_b.distance();
  if (distance > a.reach + b.reach) return false;
  return has_sample_inside(a, b, T_a_b) || has_sample_inside(b, a, T_a_b.inverse());
}

Neighbours find_neighbours(const Map& map, const NeighbourOptions& options) {
  const std::size_t count = map.patch_count();
  const InformationGraph graph = information_graph(map);
  double reach = 0;
  for (std::size_t i = 0; i < count; ++i) reach = std::max(reach, map.patch(make_id<PatchId>(i)).reach);
  std::vector<std::vector<PatchId>> confident(count);
  for (std::size_t i = 0; i < count; ++i) {
    const BoundOptions bound =
        bound_options(map.patch(make_id<PatchId>(i)), options.position, options.heading, 2 * reach);
    for (const BoundedPose& pose : tree_bound(graph, map.poses(), static_cast<std::uint32_t>(i), bound)) {
      confident[i].push_back(PatchId{pose.pose});
    }
    std::sort(confident[i].begin(), confident[i].end());
  }
  Neighbours neighbours{std::vector<std::vector<PatchId>>(count), std::vector<std::vector<PatchId>>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    const auto a = make_id<PatchId>(i);
    for (std::size_t j = i + 1; j < count; ++j) {
      const auto b = make_id<PatchId>(j);
      if (map.island_of(a) != map.island_of(b)) continue;
      const Patch& patch_a = map.patch(a);
      const Patch& patch_b = map.patch(b);
      const Vector2d apart = map.T_plane_patch(b).translation() - map.T_plane_patch(a).translation();
      const double reach_sum = patch_a.reach + patch_b.reach;
      if (apart.squaredNorm() > reach_sum * reach_sum) continue;
      if (!free_space_overlaps(patch_a, patch_b, map.T_plane_patch(a).inverse() * map.T_plane_patch(b))) continue;
      const bool near = contains_id(confident[i], b) && contains_id(confident[j], a);
      auto& lists = near ? neighbours.of : neighbours.strangers;
      lists[i].push_back(b);
      lists[j].push_back(a);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::sort(neighbours.of[i].begin(), neighbours.of[i].end());
    std::sort(neighbours.strangers[i].begin(), neighbours.strangers[i].end());
  }
  return neighbours;
}

}  // namespace helicoid
