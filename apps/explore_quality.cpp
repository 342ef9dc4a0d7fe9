#include "apps/explore_quality.hpp"

#include "helicoid/charts/occupancy_grid.hpp"
#include "helicoid/eval/trajectory_error.hpp"
#include "helicoid/simulation/reachable_floor.hpp"
#include "helicoid/simulation/seen_walls.hpp"

namespace helicoid {

namespace {

MappedCell mapped(CellState state) {
  switch (state) {
    case CellState::free: return MappedCell::free;
    case CellState::occupied: return MappedCell::occupied;
    case CellState::unknown: break;
  }
  return MappedCell::unknown;
}

/// How an island's plane lies in the world, by its robots' ways: where each was and a place a metre ahead of it, so
/// that one that never left its place says it, too.
Pose2 first_guess(const Map& map, const Island& island, std::span<const TrueTrack> tracks) {
  std::vector<Vector2d> p_plane;
  std::vector<Vector2d> p_world;
  for (std::size_t r = 0; r < map.robots().size(); ++r) {
    std::size_t i = 0;
    for (const TrackedScan& scan : map.robots()[r].trajectory) {
      if (map.island_of(scan.pose.patch) == island.id && i < tracks[r].T_world_robot.size()) {
        const Pose2 T_plane_robot = map.project(scan.pose);
        for (const Vector2d& p_robot : {Vector2d(0, 0), Vector2d(1, 0)}) {
          p_plane.push_back(T_plane_robot * p_robot);
          p_world.push_back(tracks[r].T_world_robot[i] * p_robot);
        }
      }
      ++i;
    }
  }
  return align_points(p_plane, p_world);
}

MappedChart chart_of(const Map& map, const Island& island, std::span<const TrueTrack> tracks) {
  const GridFrame frame = frame_around(map, island.patches);
  const std::vector<CellState> cells = classify(draw_occupancy(map, island.patches, frame));
  MappedChart chart;
  chart.origin = frame.origin;
  chart.cell = frame.resolution;
  chart.width = frame.width;
  chart.height = frame.height;
  chart.cells.reserve(cells.size());
  for (const CellState cell : cells) chart.cells.push_back(mapped(cell));
  chart.T_world_plane = first_guess(map, island, tracks);
  return chart;
}

}  // namespace

Result<BuildingTruth> BuildingTruth::of(const World& world, std::span<const Pose2> starts, double radius) {
  FloorOptions options;
  options.radius = radius;
  const Result<ReachableFloor> floor = find_reachable_floor(world, starts, options);
  if (!floor) return tl::unexpected(floor.error());
  BuildingTruth truth;
  truth.walls_ = world.walls;
  truth.seen_walls_ = find_seen_walls(world, *floor);
  truth.reachable_ = floor->swept_centres();
  truth.cell_ = floor->cell;
  truth.reachable_m2_ = floor->area();
  return truth;
}

MapQuality BuildingTruth::judge(const Map& map, std::span<const TrueTrack> tracks) const {
  std::vector<MappedChart> charts;
  for (const Island& island : map.islands()) charts.push_back(chart_of(map, island, tracks));
  return map_quality(charts, {walls_, seen_walls_, reachable_, cell_});
}

}  // namespace helicoid
