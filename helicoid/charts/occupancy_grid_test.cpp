#include "helicoid/charts/occupancy_grid.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;

struct Drawn {
  OccupancyGrid grid;
  std::vector<CellState> states;
};

Drawn draw(const Builder& builder, int threads = 1) {
  const auto patches = builder.patches();
  Drawn drawn{draw_occupancy(builder.map, patches, frame_around(builder.map, patches), threads), {}};
  drawn.states = classify(drawn.grid);
  return drawn;
}

double distance_to_walls(const std::vector<synthetic::Wall>& walls, const Vector2d& p) {
  double nearest = 1e9;
  for (const auto& wall : walls) {
    const Vector2d along = wall.to - wall.from;
    const double at = std::clamp((p - wall.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - wall.from - at * along).norm());
  }
  return nearest;
}

TEST(OccupancyGrid, HasOccupiedCellsWithinACellOfWallsAndNowhereElse) {
  const Drawn drawn = draw(synthetic::pillar_map());
  const auto walls = synthetic::pillar_room();
  const GridFrame& frame = drawn.grid.frame;
  int occupied = 0;
  for (int row = 0; row < frame.height; ++row) {
    for (int column = 0; column < frame.width; ++column) {
      if (drawn.states[frame.index(column, row)] != CellState::occupied) continue;
      ++occupied;
      EXPECT_LE(distance_to_walls(walls, frame.centre(column, row)), 1.01 * frame.resolution);
    }
  }
  EXPECT_GT(occupied, 400);
}

TEST(OccupancyGrid, DrawsWallsWithoutGaps) {
  const Drawn drawn = draw(synthetic::pillar_map());
  const GridFrame& frame = drawn.grid.frame;
  int missing = 0;
  for (const auto& wall : synthetic::pillar_room()) {
    for (double at = 0.1; at <= 0.9; at += 0.01) {
      const Vector2d cell = frame.to_cells(wall.from + at * (wall.to - wall.from));
      bool found = false;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto column = static_cast<int>(std::floor(cell.x())) + dx;
          const auto row = static_cast<int>(std::floor(cell.y())) + dy;
          found |= drawn.states[frame.index(column, row)] == CellState::occupied;
        }
      }
      missing += found ? 0 : 1;
    }
  }
  EXPECT_EQ(missing, 0);
}

TEST(OccupancyGrid, CallsFreeOnlyWhatAScanSaw) {
  const Builder builder = synthetic::pillar_map();
  const Drawn drawn = draw(builder);
  const GridFrame& frame = drawn.grid.frame;
  int free = 0;
  for (int row = 0; row < frame.height; ++row) {
    for (int column = 0; column < frame.width; ++column) {
      if (drawn.states[frame.index(column, row)] != CellState::free) continue;
      ++free;
      bool seen = false;
      for (const PatchId id : builder.patches()) {
        seen |= contains(builder.map.patch(id), builder.map.T_plane_patch(id).inverse() * frame.centre(column, row));
      }
      EXPECT_TRUE(seen) << frame.centre(column, row).transpose();
    }
  }
  // The room is 48 square metres with a pillar of one in it; a cell along the walls is left undecided.
  EXPECT_NEAR(free * frame.resolution * frame.resolution, 47, 2.5);
}

TEST(OccupancyGrid, LeavesTheInsideOfAPillarUnknown) {
  const Drawn drawn = draw(synthetic::pillar_map());
  const Vector2d cell = drawn.grid.frame.to_cells({4.5, 3});
  const std::size_t index = drawn.grid.frame.index(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
  EXPECT_EQ(drawn.states[index], CellState::unknown);
  EXPECT_DOUBLE_EQ(drawn.grid.probability(index), 0.5);
}

TEST(OccupancyGrid, ForgetsWhatStoodThereOnlyOnce) {
  Builder builder = synthetic::pillar_map();
  auto with_person = synthetic::pillar_room();
  synthetic::append(with_person, synthetic::rectangle(1.8, 3.0, 2.1, 3.3));
  builder.add(with_person, {1, 3.15, 0});
  const Drawn drawn = draw(builder);
  const Vector2d cell = drawn.grid.frame.to_cells({1.81, 3.15});
  EXPECT_EQ(drawn.states[drawn.grid.frame.index(static_cast<int>(cell.x()), static_cast<int>(cell.y()))],
            CellState::free);
}

TEST(OccupancyGrid, IsTheSameForAnyNumberOfThreads) {
  const Builder builder = synthetic::pillar_map(20);
  const Drawn one = draw(builder, 1);
  for (const int threads : {2, 3, 7}) {
    const Drawn many = draw(builder, threads);
    EXPECT_EQ(many.grid.hits, one.grid.hits);
    EXPECT_EQ(many.grid.misses, one.grid.misses);
  }
}

TEST(OccupancyGrid, OfNoPatchesIsUnknown) {
  const Map map;
  const GridFrame frame = frame_around(map, {});
  EXPECT_EQ(classify(draw_occupancy(map, {}, frame)).at(0), CellState::unknown);
}

TEST(GridFrame, LiesOnWholeCellsAndHoldsEverything) {
  const Builder builder = synthetic::pillar_map();
  const GridFrame frame = frame_around(builder.map, builder.patches());
  EXPECT_NEAR(std::remainder(frame.origin.x(), frame.resolution), 0, 1e-9);
  const Vector2d low = frame.to_cells({0, 0});
  const Vector2d high = frame.to_cells({8, 6});
  EXPECT_TRUE(frame.inside(static_cast<int>(low.x()) - 9, static_cast<int>(low.y()) - 9));
  EXPECT_TRUE(frame.inside(static_cast<int>(high.x()) + 9, static_cast<int>(high.y()) + 9));
}

TEST(GridFrame, CoarsensWhatWouldNotFit) {
  const Builder builder = synthetic::pillar_map();
  const GridFrame frame = frame_around(builder.map, builder.patches(), {.largest_size = 10000});
  EXPECT_LE(frame.size(), 10000U);
  EXPECT_DOUBLE_EQ(frame.resolution, 0.1);
}

}  // namespace
}  // namespace helicoid
