#include "helicoid/simulation/starts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "helicoid/simulation/live_simulation.hpp"
#include "helicoid/simulation/reachable_floor.hpp"

namespace helicoid {
namespace {

using testing::HasSubstr;

StartOptions so_many(std::size_t robots, std::uint64_t seed = 1) {
  StartOptions options;
  options.robots = robots;
  options.seed = seed;
  return options;
}

std::vector<LiveRobot> robots_at(const std::vector<Pose2>& starts) {
  std::vector<LiveRobot> robots;
  robots.reserve(starts.size());
  for (const Pose2& start : starts) robots.push_back({start});
  return robots;
}

TEST(Starts, AreReadOneALine) {
  const auto starts = parse_starts("# at the door\n1 2 90\n\n  -1.5 0 -180 # back\n", "f");
  ASSERT_TRUE(starts.has_value());
  ASSERT_EQ(starts->size(), 2U);
  EXPECT_DOUBLE_EQ((*starts)[0].yaw, radians(90));
  EXPECT_EQ((*starts)[1].translation(), Vector2d(-1.5, 0));
}

TEST(Starts, SayWhichLineIsWrong) {
  EXPECT_THAT(parse_starts("1 2 3\n1 2\n", "f").error().message, HasSubstr("f:2"));
  EXPECT_THAT(parse_starts("1 x 3\n", "f").error().message, HasSubstr("'x'"));
  EXPECT_THAT(parse_starts("1 2 nan\n", "f").error().message, HasSubstr("'nan'"));
  EXPECT_THAT(parse_starts("# nothing\n", "f").error().message, HasSubstr("no start"));
  EXPECT_THAT(choose_starts(*load_world("room"), "/no/such", so_many(1)).error().message, HasSubstr("/no/such"));
}

TEST(Starts, AreTheWorldsOwnWhereItHasEnough) {
  const Result<World> world = load_world("office");
  EXPECT_EQ(*choose_starts(*world, "", so_many(4)), world->starts);
  EXPECT_EQ(choose_starts(*world, "", so_many(2))->size(), 2U);
  EXPECT_EQ(choose_starts(*world, "", so_many(8))->size(), 8U);
}

TEST(Starts, ThatArePlacedLetRobotsBeginInEveryShippedWorld) {
  for (const std::string& name : shipped_worlds()) {
    const Result<World> world = load_world(name);
    for (const std::size_t robots : {1, 2, 4, 8}) {
      const auto starts = place_starts(*world, so_many(robots));
      ASSERT_TRUE(starts.has_value()) << starts.error().message;
      ASSERT_EQ(starts->size(), robots);
      EXPECT_TRUE(LiveSimulation::make(*world, robots_at(*starts), {}).has_value()) << name << " " << robots;
      const auto floor = find_reachable_floor(*world, world->starts);
      for (const Pose2& start : *starts) EXPECT_TRUE(floor->holds_robot(start.translation()));
    }
  }
}

TEST(Starts, OfAGroupSeeOneAnotherAndGroupsAreApart) {
  const Result<World> world = load_world("office");
  const RayCaster walls(world->walls);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto starts = *place_starts(*world, so_many(4, seed));
    for (const std::size_t first : {0, 2}) {
      const Vector2d way = starts[first + 1].translation() - starts[first].translation();
      EXPECT_LT(way.norm(), 5);
      EXPECT_GE(way.norm(), 1);
      EXPECT_EQ(walls.cast(starts[first].translation(), way.normalized(), way.norm()).segment, -1);
    }
    EXPECT_GT((starts[0].translation() - starts[2].translation()).norm(), 5);
  }
}

TEST(Starts, DependOnTheSeedAlone) {
  const Result<World> world = load_world("office");
  EXPECT_EQ(*place_starts(*world, so_many(4, 7)), *place_starts(*world, so_many(4, 7)));
  EXPECT_NE(*place_starts(*world, so_many(4, 7)), *place_starts(*world, so_many(4, 8)));
}

TEST(Starts, OfAWorldWithoutAnyAreInItsLargestClosedSpace) {
  Result<World> world = load_world("office");
  world->starts.clear();
  const auto starts = place_starts(*world, so_many(4));
  ASSERT_TRUE(starts.has_value()) << starts.error().message;
  const auto floor = find_reachable_floor(*load_world("office"), load_world("office")->starts);
  for (const Pose2& start : *starts) EXPECT_TRUE(floor->holds_robot(start.translation()));
}

/// A room of six metres by six and a ray out of it, ten metres long and 0.46 m wide.
World room_with_a_ray() {
  World world;
  const Vector2d corners[] = {{0, 0}, {6, 0}, {6, 2.77}, {16, 2.77}, {16, 3.23}, {6, 3.23}, {6, 6}, {0, 6}};
  for (int i = 0; i < 8; ++i) world.walls.push_back({corners[i], corners[(i + 1) % 8]});
  return world;
}

TEST(Starts, AreNotInARayThatIsJustWideEnough) {
  const World world = room_with_a_ray();
  ASSERT_TRUE(find_reachable_floor(world, std::vector<Pose2>{{3, 3, 0}})->holds_robot({12, 3}));
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto starts = place_starts(world, so_many(4, seed));
    ASSERT_TRUE(starts.has_value()) << starts.error().message;
    for (const Pose2& start : *starts) EXPECT_LT(start.x, 6);
  }
}

TEST(Starts, AreNotInARoomWithASpeckInItsDoor) {
  World world;
  // A roomy hall of 6 m by 6 m whose door of 0.9 m has a speck in its middle; the rest is a long corridor.
  world.walls = {{{0, 0}, {6, 0}},          {{6, 0}, {6, 2.55}},      {{6, 3.45}, {6, 6}}, {{6, 6}, {0, 6}},
                 {{0, 6}, {0, 0}},          {{6, 2}, {40, 2}},        {{40, 2}, {40, 4}},  {{40, 4}, {6, 4}},
                 {{6, 2.98}, {6.04, 2.98}}, {{6, 3.02}, {6.04, 3.02}}};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto starts = place_starts(world, so_many(4, seed));
    ASSERT_TRUE(starts.has_value()) << starts.error().message;
    for (const Pose2& start : *starts) EXPECT_GT(start.x, 6);
  }
}

TEST(Starts, AreRefusedWhereThereIsNoRoomForSoMany) {
  World world;
  const Vector2d corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int i = 0; i < 4; ++i) world.walls.push_back({corners[i], corners[(i + 1) % 4]});
  world.starts = {{0.5, 0.5, 0}};
  EXPECT_TRUE(place_starts(world, so_many(1)).has_value());
  EXPECT_THAT(place_starts(world, so_many(30)).error().message, HasSubstr("no room for 30"));
}

}  // namespace
}  // namespace helicoid
