#include "helicoid/eval/map_quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

/// A room of 10 x 6 m with a block in it, in pieces of 5 cm, and its floor in cells of 5 cm.
struct Room {
  std::vector<Segment> walls;
  std::vector<Segment> pieces;
  std::vector<Vector2d> floor;

  Room() {
    add_rectangle({0, 0}, {10, 6});
    add_rectangle({3, 2}, {4.5, 2.8});
    for (const Segment& wall : walls) {
      const Vector2d along = wall.to - wall.from;
      const int count = static_cast<int>(std::ceil(along.norm() / 0.05));
      for (int k = 0; k < count; ++k) {
        pieces.push_back({wall.from + k * along / count, wall.from + (k + 1) * along / count});
      }
    }
    for (int row = 0; row < 120; ++row) {
      for (int column = 0; column < 200; ++column) floor.push_back(0.05 * Vector2d(column + 0.5, row + 0.5));
    }
  }
  void add_rectangle(const Vector2d& low, const Vector2d& high) {
    const Vector2d corners[] = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    for (int i = 0; i < 4; ++i) walls.push_back({corners[i], corners[(i + 1) % 4]});
  }
  [[nodiscard]] TrueBuilding truth() const { return {walls, pieces, floor, 0.05}; }
};

/// What a perfect mapper draws whose plane lies so in the world: all is free within x_world < `until`, walls occupied.
MappedChart perfect_chart(const Room& room, const Pose2& T_world_plane, double until = 100) {
  MappedChart chart;
  chart.origin = {-15, -15};
  chart.width = chart.height = 600;
  chart.cells.assign(360000, MappedCell::unknown);
  for (std::size_t i = 0; i < chart.cells.size(); ++i) {
    const Vector2d p = T_world_plane * chart.centre(i);
    if (p.x() > 0 && p.x() < std::min(10.0, until) && p.y() > 0 && p.y() < 6) chart.cells[i] = MappedCell::free;
  }
  for (const Segment& piece : room.pieces) {
    for (const double share : {0.0, 0.25, 0.5, 0.75}) {
      const Vector2d p_world = piece.from + share * (piece.to - piece.from);
      if (p_world.x() > until) continue;
      const Vector2d at = (T_world_plane.inverse() * p_world - chart.origin) / chart.cell;
      chart.cells[static_cast<std::size_t>(at.y()) * 600 + static_cast<std::size_t>(at.x())] = MappedCell::occupied;
    }
  }
  chart.T_world_plane = T_world_plane;
  return chart;
}

TEST(MapQuality, OfThePerfectMapIsPerfectToACell) {
  const Room room;
  const MappedChart chart = perfect_chart(room, {3, 2, 0.4});
  const MapQuality quality = map_quality(std::span(&chart, 1), room.truth());
  EXPECT_TRUE(quality.aligned[0]);
  EXPECT_EQ(quality.wall_recall, 1);
  EXPECT_LT(quality.wall_rms_m, 0.05 / std::sqrt(6.0));  // within a cell, in both axes
  EXPECT_NEAR(quality.reachable_m2, 60, 1e-6);
  EXPECT_GT(quality.mapped_fraction, 0.998);
}

TEST(MapQuality, DoesNotDependOnWhereThePlaneLies) {
  const Room room;
  const Pose2 T_world_plane{3, 2, 0.4};
  Random random(2);
  for (int k = 0; k < 10; ++k) {
    MappedChart chart = perfect_chart(room, T_world_plane);
    const Pose2 off{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-0.06, 0.06)};
    chart.T_world_plane = T_world_plane * off;
    const MapQuality quality = map_quality(std::span(&chart, 1), room.truth());
    EXPECT_TRUE(quality.aligned[0]);
    const Pose2 error = T_world_plane.inverse() * quality.T_world_plane[0];
    EXPECT_LT(error.distance(), 0.01);
    EXPECT_LT(std::abs(error.yaw), radians(0.1));
    EXPECT_EQ(quality.wall_recall, 1);
  }
}

TEST(MapQuality, AWallThatIsNotMappedIsMissedByItsLength) {
  const Room room;
  const MappedChart chart = perfect_chart(room, {}, 9.5);  // without the wall at x = 10 and half a metre of two others
  const MapQuality quality = map_quality(std::span(&chart, 1), room.truth());
  const double all = 32 + 2 * (1.5 + 0.8);
  EXPECT_NEAR(quality.wall_recall, 1 - (6 + 1 - 2 * 0.1) / all, 0.004);
  EXPECT_NEAR(quality.mapped_fraction, 0.95, 0.006);
}

TEST(MapQuality, GhostsCountAsErrorsAndDoNotPullAtTheMap) {
  const Room room;
  const Pose2 T_world_plane{3, 2, 0.4};
  MappedChart chart = perfect_chart(room, T_world_plane);
  const auto walls = static_cast<double>(std::count(chart.cells.begin(), chart.cells.end(), MappedCell::occupied));
  for (double y = 1; y < 5; y += 0.02) {  // the wall at x = 10 once more
    const Vector2d at = (T_world_plane.inverse() * Vector2d(9, y) - chart.origin) / chart.cell;
    chart.cells[static_cast<std::size_t>(at.y()) * 600 + static_cast<std::size_t>(at.x())] = MappedCell::occupied;
  }
  const auto all = static_cast<double>(std::count(chart.cells.begin(), chart.cells.end(), MappedCell::occupied));
  const MapQuality quality = map_quality(std::span(&chart, 1), room.truth());
  EXPECT_LT((T_world_plane.inverse() * quality.T_world_plane[0]).distance(), 0.01);
  EXPECT_NEAR(quality.wall_rms_m, std::sqrt((all - walls) / all), 0.01);
  EXPECT_EQ(quality.wall_recall, 1);
}

TEST(MapQuality, OfTwoIslandsIsThatOfBothTogether) {
  const Room room;
  const std::vector<MappedChart> charts{perfect_chart(room, {1, 0, 0.1}, 6), perfect_chart(room, {0, 1, -2})};
  const MapQuality quality = map_quality(charts, room.truth());
  EXPECT_EQ(quality.aligned, (std::vector<bool>{true, true}));
  EXPECT_EQ(quality.wall_recall, 1);
  EXPECT_GT(quality.mapped_fraction, 0.998);
}

TEST(MapQuality, OfNothingIsNothing) {
  const Room room;
  const MapQuality none = map_quality({}, room.truth());
  EXPECT_EQ(none.mapped_m2, 0);
  EXPECT_EQ(none.wall_recall, 0);
  MappedChart chart = perfect_chart(room, {});
  chart.cells.assign(chart.cells.size(), MappedCell::unknown);
  EXPECT_FALSE(map_quality(std::span(&chart, 1), room.truth()).aligned[0]);
}

}  // namespace
}  // namespace helicoid
