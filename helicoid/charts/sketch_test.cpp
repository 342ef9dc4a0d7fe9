#include "helicoid/charts/sketch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "helicoid/charts/sketch_svg.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

using testing::HasSubstr;

OccupancyGrid draw(const synthetic::Builder& builder) {
  return draw_occupancy(builder.map, builder.patches(), frame_around(builder.map, builder.patches()));
}

double free_area(const OccupancyGrid& grid) {
  const auto states = classify(grid);
  return static_cast<double>(std::count(states.begin(), states.end(), CellState::free)) * grid.frame.resolution *
         grid.frame.resolution;
}

/// A grid drawn by hand: '.' free, '#' occupied, ' ' unknown; the first line is the lowest row.
OccupancyGrid from_text(const std::vector<std::string>& rows) {
  OccupancyGrid grid;
  grid.frame = {{0, 0}, 0.05, static_cast<int>(rows[0].size()), static_cast<int>(rows.size())};
  for (const std::string& row : rows) {
    for (const char c : row) {
      grid.hits.push_back(c == '#' ? 9 : 0);
      grid.misses.push_back(c == '.' ? 9 : 0);
    }
  }
  return grid;
}

double length(const Sketch& sketch, Border border) {
  double sum = 0;
  for (const SketchRing& ring : sketch.rings) {
    for (std::size_t i = 0; i < ring.points.size(); ++i) {
      if (ring.borders[i] == border) sum += (ring.points[(i + 1) % ring.points.size()] - ring.points[i]).norm();
    }
  }
  return sum;
}

TEST(Sketch, HasTheAreaOfTheRaster) {
  const OccupancyGrid grid = draw(synthetic::pillar_map());
  const double raster = free_area(grid);
  EXPECT_NEAR(area(make_sketch(grid)), raster, 0.02 * raster);
}

TEST(Sketch, KeepsTheHoleOfAPillar) {
  const Sketch sketch = make_sketch(draw(synthetic::pillar_map()));
  ASSERT_EQ(sketch.rings.size(), 2U);
  for (const Vector2d& p : sketch.rings[1].points) {
    EXPECT_NEAR((p - Vector2d(4.5, 3)).cwiseAbs().maxCoeff(), 0.55, 0.12) << p.transpose();
  }
}

TEST(Sketch, DrawsStraightWallsWithFewPoints) {
  // Walls on the border between two cells fall into either: two centimetres aside they do not.
  synthetic::Builder builder;
  const synthetic::Builder aligned = synthetic::pillar_map();
  for (const PatchId id : aligned.patches()) {
    const Pose2 pose = aligned.map.T_plane_patch(id);
    builder.add(synthetic::pillar_room(), pose, Pose2{0.02, 0.02, 0} * pose);
  }
  const Sketch sketch = make_sketch(draw(builder));
  EXPECT_LE(sketch.rings[0].points.size(), 24U);
  EXPECT_LE(sketch.rings[1].points.size(), 16U);
}

TEST(Sketch, CallsEverythingWallInAClosedRoom) {
  const Sketch sketch = make_sketch(draw(synthetic::pillar_map()));
  EXPECT_EQ(length(sketch, Border::frontier), 0);
  EXPECT_NEAR(length(sketch, Border::wall), 28 + 4, 1.5);
}

TEST(Sketch, CallsTheOpenEndOfACorridorAFrontier) {
  synthetic::Builder builder;
  const std::vector<synthetic::Wall> walls{{{-2, -1}, {30, -1}}, {{30, 1}, {-2, 1}}, {{-2, 1}, {-2, -1}}};
  builder.add(walls, {0, 0, 0});
  builder.add(walls, {1, 0, radians(180)});
  builder.add(walls, {2, 0, 0});
  const Sketch sketch = make_sketch(draw(builder));
  EXPECT_GT(length(sketch, Border::frontier), 1.0);
  EXPECT_GT(length(sketch, Border::wall), 10.0);
}

TEST(Sketch, KeepsThinDiagonalWallsClosed) {
  const Sketch sketch = make_sketch(
      from_text({"#.......", ".#......", "..#.....", "...#....", "....#...", ".....#..", "......#.", ".......#"}),
      {.smallest_piece = 0});
  EXPECT_EQ(sketch.rings.size(), 2U);
}

TEST(Sketch, CountsTheSpecksThatItDrops) {
  const Sketch sketch = make_sketch(from_text({"     ", " .   ", "     ", "   . ", "     "}));
  EXPECT_EQ(sketch.rings.size(), 0U);
  EXPECT_EQ(sketch.dropped_specks, 2);
}

TEST(Sketch, FillsPinholesButNotPosts) {
  std::vector<std::string> rows(20, std::string(20, '.'));
  rows[5][5] = ' ';
  rows[14][14] = '#';
  const Sketch sketch = make_sketch(from_text(rows));
  EXPECT_EQ(sketch.filled_holes, 1);
  EXPECT_EQ(sketch.rings.size(), 2U);
}

/// True if every element that is opened is closed, in order, and every attribute quoted.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (tag.find('<') != std::string::npos || std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
    if (tag[0] == '?') continue;
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
  }
  return open.empty();
}

SketchDrawing drawing() {
  const synthetic::Builder builder = synthetic::pillar_map();
  return {{{"sheet 0", make_sketch(draw(builder))}}, ways_over(builder.map, builder.patches()), {}, "a <room> & more"};
}

TEST(SketchSvg, IsWellFormed) {
  const std::string svg = to_svg(drawing());
  EXPECT_TRUE(well_formed(svg)) << svg;
  EXPECT_THAT(svg, HasSubstr("a &lt;room&gt; &amp; more"));
  EXPECT_THAT(svg, HasSubstr("<g id=\"sheet 0\">"));
}

TEST(SketchSvg, IsSmall) {
  EXPECT_LT(to_svg(drawing()).size(), 3000U);
}

TEST(SketchSvg, HoldsAnEmptyDrawing) {
  EXPECT_TRUE(well_formed(to_svg({})));
}

TEST(SketchSvg, IsTheSameEveryTime) {
  EXPECT_EQ(to_svg(drawing()), to_svg(drawing()));
}

}  // namespace
}  // namespace helicoid
