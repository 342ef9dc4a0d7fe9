#include "helicoid/charts/picture.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "helicoid/charts/palette.hpp"
#include "helicoid/charts/raster.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

namespace fs = std::filesystem;

SheetStack flat(const synthetic::Builder& builder, int threads = 1) {
  const auto patches = builder.patches();
  const Sheets sheets{1, std::vector<int>(patches.size(), 0)};
  const auto frame = frame_around(builder.map, patches);
  return stack(draw_sheets(builder.map, patches, sheets, frame, threads));
}

/// The same room twice, the second time 1.5 m to the right, on a sheet of its own.
SheetStack doubled() {
  synthetic::Builder builder = synthetic::pillar_map();
  const auto walls = synthetic::pillar_room();
  for (int i = 0; i < 16; ++i) {
    const Pose2 pose = builder.map.T_plane_patch(make_id<PatchId>(static_cast<std::size_t>(i)));
    builder.add(walls, pose, Pose2{1.5, 0, 0} * pose);
  }
  Sheets sheets{2, std::vector<int>(32, 0)};
  std::fill(sheets.sheet_of.begin() + 16, sheets.sheet_of.end(), 1);
  const auto patches = builder.patches();
  return stack(draw_sheets(builder.map, patches, sheets, frame_around(builder.map, patches)));
}

std::uint32_t pixel_at(const charts::Raster& raster, const GridFrame& frame, const Vector2d& p_plane) {
  const Vector2d cells = frame.to_cells(p_plane) * raster.scale;
  const int y = raster.height - 1 - static_cast<int>(cells.y());
  return raster.pixels[static_cast<std::size_t>(y) * raster.width + static_cast<std::size_t>(cells.x())];
}

TEST(Raster, ShowsFloorGroundAndWalls) {
  const SheetStack sheets = flat(synthetic::pillar_map());
  const charts::Raster raster = charts::paint(sheets, 3);
  EXPECT_EQ(pixel_at(raster, sheets.grid.frame, {2, 1}), charts::kFree);
  EXPECT_EQ(pixel_at(raster, sheets.grid.frame, {-0.4, 3}), charts::kUnknown);
  EXPECT_GT(std::count(raster.pixels.begin(), raster.pixels.end(), charts::kWall), 400);
}

TEST(SheetStack, ShowsTheFirstSheetWhereTwoOverlapAndMarksIt) {
  const SheetStack sheets = doubled();
  EXPECT_EQ(sheets.deepest, 2);
  const GridFrame& frame = sheets.grid.frame;
  const auto depth = [&](double x, double y) {
    const Vector2d cell = frame.to_cells({x, y});
    return sheets.depth[frame.index(static_cast<int>(cell.x()), static_cast<int>(cell.y()))];
  };
  EXPECT_EQ(depth(0.5, 3), 1);
  EXPECT_EQ(depth(3, 1), 2);
  EXPECT_EQ(depth(9, 3), 1);
  // The second sheet's left wall would stand at x = 1.5.
  for (double y = 1; y < 5; y += 0.1) {
    const Vector2d cell = frame.to_cells({1.5, y});
    EXPECT_EQ(sheets.grid.hits[frame.index(static_cast<int>(cell.x()), static_cast<int>(cell.y()))], 0);
  }
}

TEST(SheetStack, DrawnSheetBySheetIsTheStackOfAllSheets) {
  const synthetic::Builder builder = synthetic::pillar_map(2);
  Sheets sheets{3, {}};
  for (int i = 0; i < 32; ++i) sheets.sheet_of.push_back(i % 4 - 1);
  const auto frame = frame_around(builder.map, builder.patches());
  const SheetStack all = stack(draw_sheets(builder.map, builder.patches(), sheets, frame));
  const SheetStack one = draw_stack(builder.map, builder.patches(), sheets, frame, 2);
  EXPECT_EQ(one.grid.hits, all.grid.hits);
  EXPECT_EQ(one.grid.misses, all.grid.misses);
  EXPECT_EQ(one.depth, all.depth);
  EXPECT_EQ(one.deepest, all.deepest);
}

class Picture : public testing::Test {
 protected:
  static std::string draw(const SheetStack& sheets, const synthetic::Builder& builder, const char* name) {
    const fs::path path = fs::temp_directory_path() / fmt::format("helicoid_{}_{}.png", name, ::getpid());
    const auto written =
        write_picture(sheets, ways_over(builder.map, builder.patches()), path.string(), {.title = "a room"});
    EXPECT_TRUE(written) << written.error().message;
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    fs::remove(path);
    return bytes;
  }
};

TEST_F(Picture, IsAPng) {
  const synthetic::Builder builder = synthetic::pillar_map();
  const std::string bytes = draw(flat(builder), builder, "png");
  ASSERT_GT(bytes.size(), 1000U);
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
}

TEST_F(Picture, HasTheSameBytesForAnyNumberOfThreads) {
  const synthetic::Builder builder = synthetic::pillar_map(10);
  EXPECT_TRUE(draw(flat(builder, 1), builder, "one") == draw(flat(builder, 3), builder, "three"));
}

TEST_F(Picture, SaysWhyItCannotBeWritten) {
  const auto written = write_picture(flat(synthetic::pillar_map()), {}, "/no/such/folder/map.png");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("cannot be created"), std::string::npos);
}

}  // namespace
}  // namespace helicoid
