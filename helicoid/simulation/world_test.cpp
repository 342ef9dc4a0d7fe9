#include "helicoid/simulation/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "helicoid/simulation/svg_path.hpp"

namespace helicoid {
namespace {

TEST(World, EveryShippedOneHasWallsRoutesAndStarts) {
  for (const std::string& name : shipped_worlds()) {
    const Result<World> world = load_world(name);
    ASSERT_TRUE(world.has_value()) << name;
    EXPECT_FALSE(world->walls.empty()) << name;
    EXPECT_FALSE(world->routes.empty()) << name;
    EXPECT_FALSE(world->starts.empty()) << name;
  }
  EXPECT_THAT(shipped_worlds(), testing::IsSupersetOf({"office", "loop", "hall", "room", "branch", "corridor"}));
}

TEST(World, NoStartStandsInAWallAndNoRouteLeadsThroughOne) {
  for (const std::string& name : shipped_worlds()) {
    const Result<World> world = load_world(name);
    const RayCaster walls(world->walls);
    for (const Pose2& start : world->starts) EXPECT_GT(walls.clearance(start.translation(), 50), 0.25) << name;
    for (const Route& route : world->routes) {
      for (std::size_t i = 0; i + (route.closed ? 0 : 1) < route.points.size(); ++i) {
        const Vector2d a = route.points[i];
        const Vector2d b = route.points[(i + 1) % route.points.size()];
        EXPECT_EQ(walls.cast(a, (b - a).normalized(), (b - a).norm()).segment, -1) << name << " " << i;
      }
    }
  }
}

TEST(World, AnUnknownNameSaysWhichThereAre) {
  const Result<World> world = load_world("atlantis");
  ASSERT_FALSE(world.has_value());
  EXPECT_THAT(world.error().message, testing::AllOf(testing::HasSubstr("atlantis"), testing::HasSubstr("office")));
}

TEST(SvgWorld, TurnsTheFilesAxesUpAndAppliesTransforms) {
  const Result<World> world = parse_svg_world(
      "<svg><g transform='translate(1 2) scale(2)'><line class='wall' x1='0' y1='0' x2='1' y2='1'/></g>"
      "<circle class='start' cx='3' cy='4' data-yaw='90'/><polyline class='route' points='0,0 1,0'/></svg>",
      "test");
  ASSERT_TRUE(world.has_value());
  ASSERT_EQ(world->walls.size(), 1U);
  EXPECT_EQ(world->walls[0].from, Vector2d(1, -2));
  EXPECT_EQ(world->walls[0].to, Vector2d(3, -4));
  EXPECT_EQ(world->starts[0].translation(), Vector2d(3, -4));
  EXPECT_DOUBLE_EQ(world->starts[0].yaw, radians(90));
}

TEST(SvgWorld, ARectangleIsFourWalls) {
  const Result<World> world =
      parse_svg_world("<svg><rect class='wall' x='0' y='0' width='2' height='1'/></svg>", "test");
  ASSERT_TRUE(world.has_value());
  EXPECT_EQ(world->walls.size(), 4U);
}

TEST(SvgWorld, AThickWallIsSeenOnBothItsFaces) {
  const Result<World> world =
      parse_svg_world("<svg><line class='wall' data-thickness='0.2' x1='-5' y1='0' x2='5' y2='0'/></svg>", "test");
  ASSERT_TRUE(world.has_value());
  const RayCaster walls(world->walls);
  EXPECT_NEAR(walls.cast({0, -2}, {0, 1}, 50).distance, 1.9, 1e-12);
  EXPECT_NEAR(walls.cast({0, 2}, {0, -1}, 50).distance, 1.9, 1e-12);
  EXPECT_NEAR(walls.cast({7, 0}, {-1, 0}, 50).distance, 1.9, 1e-12);
}

TEST(SvgWorld, RefusesWhatIsNoSvgOrHasNoWall) {
  EXPECT_FALSE(parse_svg_world("<svg", "test").has_value());
  EXPECT_FALSE(parse_svg_world("", "test").has_value());
  EXPECT_THAT(parse_svg_world("<svg/>", "test").error().message, testing::HasSubstr("wall"));
}

TEST(SvgPath, RelativeAndAbsoluteCommandsAgree) {
  const auto absolute = svg_path("M1 2 L3 2 H5 V7 Z");
  const auto relative = svg_path("m1 2 l2 0 h2 v5 z");
  ASSERT_EQ(absolute.size(), 1U);
  ASSERT_EQ(relative.size(), 1U);
  EXPECT_EQ(absolute[0].points, relative[0].points);
  EXPECT_TRUE(absolute[0].closed);
}

TEST(SvgPath, ATransformThenItsInverseIsNone) {
  const SvgTransform t = svg_transform("translate(3,4) rotate(30) rotate(-30) translate(-3,-4)");
  EXPECT_LT((t(Vector2d(5, 6)) - Vector2d(5, 6)).norm(), 1e-12);
}

class ImageWorld : public testing::Test {
 protected:
  /// A room of 4 x 3 cells of half a metre; `inside` is its grey value.
  std::string write(const std::string& keys, char inside) {
    // Tests run side by side: each has files of its own.
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder);
    std::ofstream pgm(folder / "room.pgm", std::ios::binary);
    pgm << "P5\n# a comment\n6 5\n255\n";
    for (int row = 0; row < 5; ++row) {
      for (int column = 0; column < 6; ++column) {
        const bool floor = row > 0 && row < 4 && column > 0 && column < 5;
        pgm.put(floor ? inside : static_cast<char>(205));
      }
    }
    std::ofstream(folder / "room.yaml") << keys;
    return (folder / "room.yaml").string();
  }
};

TEST_F(ImageWorld, UnknownCellsAreSolidAndBordersAreJoined) {
  const auto world =
      read_image_world(write("image: room.pgm\nresolution: 0.5\norigin: [-1, -2, 0]\n", static_cast<char>(254)));
  ASSERT_TRUE(world.has_value()) << world.error().message;
  EXPECT_EQ(world->walls.size(), 4U);
  const RayCaster walls(world->walls);
  EXPECT_DOUBLE_EQ(walls.cast({0.5, -0.75}, {1, 0}, 50).distance, 1.0);
  EXPECT_DOUBLE_EQ(walls.cast({0.5, -0.75}, {-1, 0}, 50).distance, 1.0);
  EXPECT_DOUBLE_EQ(walls.cast({0.5, -0.75}, {0, 1}, 50).distance, 0.75);
}

/// A PGM whose rows are drawn: '.' is free, '?' unknown, the rest solid.
std::string drawn(const std::vector<std::string>& rows, bool in_words = false) {
  std::string image = (in_words ? "P2\n" : "P5\n") + std::to_string(rows[0].size()) + " " +
                      std::to_string(rows.size()) + (in_words ? "\n100\n" : "\n255\n");
  for (const std::string& row : rows) {
    for (const char c : row) {
      if (in_words) {
        image += c == '.' ? "100 " : "0 ";
      } else {
        image += static_cast<char>(c == '.' ? 254 : c == '?' ? 205 : 0);
      }
    }
  }
  return image;
}

TEST(ImageText, TheGreyOfTheUnknownIsSolidWhateverTheThreshold) {
  const std::string image = drawn({"?????", "?...?", "?...?", "?????"});
  const auto strict = parse_image_world("resolution: 0.5\nfree_thresh: 0.196\n", image, "m");
  const auto loose = parse_image_world("resolution: 0.5\nfree_thresh: 0.25\n", image, "m");
  ASSERT_TRUE(strict.has_value() && loose.has_value());
  EXPECT_EQ(strict->walls.size(), 4U);
  EXPECT_EQ(loose->walls.size(), 4U);
}

TEST(ImageText, WordsAndBytesAreTheSameImage) {
  const std::vector<std::string> rows{"#####", "#...#", "##..#", "#####"};
  const auto bytes = parse_image_world("resolution: 0.5\n", drawn(rows), "m");
  const auto words = parse_image_world("resolution: 0.5\n", drawn(rows, true), "m");
  ASSERT_TRUE(bytes.has_value() && words.has_value()) << words.error().message;
  EXPECT_EQ(to_yaml(*bytes), to_yaml(*words));
}

TEST(ImageText, AnOriginMayBeAListBelowItsKey) {
  const std::string image = drawn({"###", "#.#", "###"});
  const auto line = parse_image_world("resolution: 0.5\norigin: [-1, 2.5, 0]\n", image, "m");
  const auto list = parse_image_world("origin:\n- -1\n- 2.5\n- 0.0\nresolution: 0.5  # metres\n", image, "m");
  ASSERT_TRUE(line.has_value() && list.has_value()) << list.error().message;
  EXPECT_EQ(to_yaml(*line), to_yaml(*list));
}

TEST(ImageText, ItsStartIsInTheLargestSpaceNotInTheDeepestPocket) {
  // At 0.5 m a pixel: a square pocket of 2.5 m, and a corridor 1.5 m wide and 10 m long.
  const auto world = parse_image_world(
      "resolution: 0.5\n",
      drawn({"############################", "#.....#....................#", "#.....#....................#",
             "#.....#....................#", "#.....######################", "#.....######################",
             "############################"}),
      "m");
  ASSERT_TRUE(world.has_value());
  EXPECT_GT(world->starts[0].x, 3.5);
}

TEST_F(ImageWorld, SaysWhatIsMissing) {
  EXPECT_THAT(read_image_world(write("image: room.pgm\n", 0)).error().message, testing::HasSubstr("resolution"));
  EXPECT_THAT(read_image_world(write("image: none.pgm\nresolution: 0.5\n", 0)).error().message,
              testing::HasSubstr("none.pgm"));
  EXPECT_FALSE(read_image_world(write("image: room.pgm\nresolution: 0.5\n", 0)).has_value());
}

}  // namespace
}  // namespace helicoid
