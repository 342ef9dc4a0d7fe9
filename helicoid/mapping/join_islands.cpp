#include "helicoid/mapping/join_islands.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/fit_islands.hpp"

namespace helicoid {

namespace {

std::size_t patches_on(const Map& map, IslandId island) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < map.patch_count(); ++i) count += map.island_of(make_id<PatchId>(i)) == island ? 1 : 0;
  return count;
}

}  // namespace

void move_rigidly(MapInProgress& progress, const IslandJoin& join) {
  const Map& map = progress.map;
  const IslandId a = map.island_of(join.a);
  const IslandId b = map.island_of(join.b);
  const Pose2 T_plane_a_plane_b = map.T_plane_patch(join.a) * join.T_a_b * map.T_plane_patch(join.b).inverse();
  if (patches_on(map, a) < patches_on(map, b)) {
    progress.editor.merge_islands(b, a, T_plane_a_plane_b.inverse());
  } else {
    progress.editor.merge_islands(a, b, T_plane_a_plane_b);
  }
}

void join_islands(MapInProgress& progress, LoopCloser& closer, const IslandJoin& join, const MapperOptions& options) {
  move_rigidly(progress, join);
  progress.add(
      {join.a, join.b, RelationKind::sighting, pose_pose_form(join.T_a_b, join.information), join.T_a_b, 0, 0, 0});
  fit_islands(progress.map, progress.editor);
  progress.graph = information_graph(progress.map);
  if (options.closures) close_loops_again(progress, closer, options);
}

}  // namespace helicoid
