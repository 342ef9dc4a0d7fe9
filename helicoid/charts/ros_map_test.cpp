#include "helicoid/charts/ros_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class RosMap : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("helicoid_ros_map_{}", ::getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

/// 3 x 2 cells: the lower left one occupied, the one to its right free, the rest unknown.
OccupancyGrid small_grid() {
  OccupancyGrid grid{{{-1.5, 2.25}, 0.05, 3, 2}, {9, 0, 0, 0, 0, 0}, {0, 9, 0, 0, 0, 0}, {}};
  return grid;
}

TEST_F(RosMap, PutsTheLowestRowLast) {
  ASSERT_TRUE(write_ros_map(small_grid(), (folder_ / "map").string()));
  const std::string image = read(folder_ / "map.pgm");
  const std::string header = "P5\n3 2\n255\n";
  ASSERT_EQ(image.size(), header.size() + 6);
  EXPECT_EQ(image.substr(0, header.size()), header);
  const std::vector<int> expected{205, 205, 205, 0, 254, 205};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(static_cast<unsigned char>(image[header.size() + i]), expected[i]) << i;
  }
}

TEST_F(RosMap, SaysWhereItsLowerLeftCornerLies) {
  ASSERT_TRUE(write_ros_map(small_grid(), (folder_ / "map").string()));
  const std::string yaml = read(folder_ / "map.yaml");
  EXPECT_THAT(yaml, HasSubstr("image: map.pgm\n"));
  EXPECT_THAT(yaml, HasSubstr("resolution: 0.050000\n"));
  EXPECT_THAT(yaml, HasSubstr("origin: [-1.500000, 2.250000, 0.0]\n"));
  EXPECT_THAT(yaml, HasSubstr("negate: 0\n"));
  EXPECT_THAT(yaml, HasSubstr("occupied_thresh: 0.65\n"));
  EXPECT_THAT(yaml, HasSubstr("free_thresh: 0.196\n"));
}

TEST_F(RosMap, ReadByItsYamlHasWallsWhereTheyStand) {
  const synthetic::Builder builder = synthetic::pillar_map();
  const GridFrame frame = frame_around(builder.map, builder.patches());
  ASSERT_TRUE(write_ros_map(draw_occupancy(builder.map, builder.patches(), frame), (folder_ / "map").string()));
  std::istringstream image(read(folder_ / "map.pgm"));
  std::string magic;
  int width = 0, height = 0, largest = 0;
  image >> magic >> width >> height >> largest;
  image.get();
  std::vector<char> pixels(static_cast<std::size_t>(width * height));
  image.read(pixels.data(), static_cast<std::streamsize>(pixels.size()));
  const std::string yaml = read(folder_ / "map.yaml");
  double origin_x = 0, origin_y = 0;
  ASSERT_EQ(std::sscanf(yaml.c_str() + yaml.find("origin"), "origin: [%lf, %lf", &origin_x, &origin_y), 2);
  const auto grey = [&](double x, double y) {
    const int column = static_cast<int>(std::floor((x - origin_x) / 0.05));
    const int row = height - 1 - static_cast<int>(std::floor((y - origin_y) / 0.05));
    return static_cast<unsigned char>(pixels[static_cast<std::size_t>(row) * width + column]);
  };
  EXPECT_EQ(grey(2, 1), 254);
  EXPECT_EQ(grey(-0.3, 3), 205);
  int walls = 0;
  for (double x = 1; x < 7; x += 0.1) walls += std::min(grey(x, -0.01), grey(x, 0.01)) == 0 ? 1 : 0;
  EXPECT_GE(walls, 58);
}

TEST_F(RosMap, SaysWhyItCannotBeWritten) {
  EXPECT_THAT(write_ros_map(small_grid(), (folder_ / "no/such/map").string()).error().message,
              HasSubstr("cannot be created"));
}

}  // namespace
}  // namespace helicoid
