#include "helicoid/simulation/reachable_floor.hpp"

#include <gtest/gtest.h>

#include "helicoid/simulation/seen_walls.hpp"

namespace helicoid {
namespace {

void add_rectangle(World& world, const Vector2d& low, const Vector2d& high) {
  const Vector2d corners[] = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  for (int i = 0; i < 4; ++i) world.walls.push_back({corners[i], corners[(i + 1) % 4]});
}

/// A room of 10 x 6 m about the origin.
World box() {
  World world;
  world.name = "box";
  add_rectangle(world, {-5, -3}, {5, 3});
  return world;
}

/// The box with a wall across that leaves an opening of this width in its middle.
World two_rooms(double opening) {
  World world = box();
  world.walls.push_back({{0.013, -3}, {0.013, -0.5 * opening}});
  world.walls.push_back({{0.013, 0.5 * opening}, {0.013, 3}});
  return world;
}

ReachableFloor floor_of(const World& world, const Pose2& start) {
  Result<ReachableFloor> floor = find_reachable_floor(world, std::vector<Pose2>{start});
  EXPECT_TRUE(floor.has_value()) << floor.error().message;
  return std::move(*floor);
}

double length(const std::vector<Segment>& pieces) {
  double sum = 0;
  for (const Segment& s : pieces) sum += (s.to - s.from).norm();
  return sum;
}

TEST(ReachableFloor, OfARectangleIsAllButItsRoundedCorners) {
  const ReachableFloor floor = floor_of(box(), {1, 1, 0});
  const double corners = (4 - std::numbers::pi) * 0.2 * 0.2;
  EXPECT_NEAR(floor.area(), 60 - corners, 0.03);
  EXPECT_TRUE(floor.enclosed);
  EXPECT_DOUBLE_EQ(static_cast<double>(floor.swept_centres().size()) * 0.05 * 0.05, floor.area());
}

TEST(ReachableFloor, IsTheSameToHalfACellAlongItsWallsHoweverTheRasterLies) {
  for (const double shift : {0.0, 0.011, 0.023, 0.037}) {
    World world = box();
    world.walls.push_back({{-6 - shift, -4 - shift}, {-6, -4}});  // the raster begins at the outermost wall
    EXPECT_NEAR(floor_of(world, {1, 1, 0}).area(), 60, 0.5 * 0.05 * 32) << shift;
  }
}

TEST(ReachableFloor, LeadsThroughAnOpeningThatTheRobotJustFits) {
  for (const double opening : {0.41, 0.43, 0.46, 0.5, 0.9}) {
    EXPECT_GT(floor_of(two_rooms(opening), {-3, 0, 0}).area(), 59) << opening;
  }
  for (const double opening : {0.3, 0.35, 0.39}) {
    EXPECT_LT(floor_of(two_rooms(opening), {-3, 0, 0}).area(), 31) << opening;
  }
}

TEST(ReachableFloor, IsThatOfAllStarts) {
  const std::vector<Pose2> starts{{-3, 0, 0}, {3, 0, 0}};
  EXPECT_GT(find_reachable_floor(two_rooms(0.2), starts)->area(), 59);
}

TEST(ReachableFloor, LeavesOutWhatStandsOnIt) {
  World world = box();
  add_rectangle(world, {1, -1}, {3, 1});
  EXPECT_NEAR(floor_of(world, {-3, 0, 0}).area(), 56, 0.15);
}

TEST(ReachableFloor, SaysWhereItLeadsOutOfTheWorld) {
  World world = box();
  world.walls.pop_back();
  EXPECT_FALSE(floor_of(world, {1, 1, 0}).enclosed);
}

TEST(ReachableFloor, RefusesStartsWhereNoRobotFits) {
  EXPECT_FALSE(find_reachable_floor(box(), {}).has_value());
  EXPECT_FALSE(find_reachable_floor(box(), std::vector<Pose2>{{4.9, 0, 0}}).has_value());
}

TEST(ReachableFloor, OfAShippedWorldIsEnclosed) {
  for (const std::string& name : shipped_worlds()) {
    const Result<World> world = load_world(name);
    const Result<ReachableFloor> floor = find_reachable_floor(*world, world->starts);
    ASSERT_TRUE(floor.has_value()) << floor.error().message;
    EXPECT_TRUE(floor->enclosed) << name;
    EXPECT_GT(floor->area(), 20) << name;
    for (const Pose2& start : world->starts) EXPECT_TRUE(floor->holds_robot(start.translation())) << name;
  }
}

TEST(SeenWalls, OfAnEmptyRoomAreAllItsWalls) {
  const World world = box();
  const std::vector<Segment> seen = find_seen_walls(world, floor_of(world, {1, 1, 0}));
  EXPECT_NEAR(length(seen), 32, 1e-9);
  for (const Segment& s : seen) EXPECT_LE((s.to - s.from).norm(), 0.05 + 1e-12);
}

TEST(SeenWalls, LeaveOutWhatIsBehindFurnitureAndInRoomsWithoutALook) {
  World world = box();
  add_rectangle(world, {3, -3}, {5, -1});  // in a corner: hides 2 m of either wall
  add_rectangle(world, {-9, -3}, {-6, 3});
  const std::vector<Segment> seen = find_seen_walls(world, floor_of(world, {-1, 1, 0}));
  EXPECT_NEAR(length(seen), 32 - 4 + 4, 0.05);
}

TEST(SeenWalls, IncludeWhatIsSeenThroughAnOpeningTooNarrowToDriveThrough) {
  const World world = two_rooms(0.3);
  const std::vector<Segment> seen = find_seen_walls(world, floor_of(world, {-3, 0, 0}));
  // The room itself, and most of the other one except beside the opening.
  EXPECT_GT(length(seen), 22 + 9);
  EXPECT_LT(length(seen), 32 + 5.7);
}

}  // namespace
}  // namespace helicoid
