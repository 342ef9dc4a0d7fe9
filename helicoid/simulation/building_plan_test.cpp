#include "helicoid/simulation/building_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "helicoid/geometry/ray_casting.hpp"
#include "helicoid/simulation/buildings.hpp"

namespace helicoid {
namespace {

std::size_t differing(std::span<const Piece> a, std::span<const Piece> b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i].T_world_piece == b[i].T_world_piece ? 0 : 1;
  return count;
}

TEST(BuildingPlan, AWallIsOpenWhereItsDoorsAre) {
  BuildingPlan plan;
  const double doors[] = {2, 5};
  plan.wall_with_doors({0, 0}, {8, 0}, doors, 1);
  const RayCaster walls(plan.walls);
  for (double x = 0.05; x < 8; x += 0.1) {
    const double from_door = std::min(std::abs(x - 2), std::abs(x - 5));
    if (std::abs(from_door - 0.5) < 0.1) continue;  // the frame
    const bool open = from_door < 0.5;
    EXPECT_EQ(std::isinf(walls.cast({x, -1}, {0, 1}, 2).distance), open) << x;
  }
}

TEST(BuildingPlan, RoomsAreEnteredByTheirDoorsAndLieToTheLeft) {
  BuildingPlan plan;
  const std::vector<Room> rooms = add_rooms(plan, {{20, 0}, {0, 0}});
  ASSERT_EQ(rooms.size(), 5U);
  const RayCaster walls(plan.walls);
  for (const Room& room : rooms) {
    EXPECT_LT(room.middle.y(), 0);
    const Vector2d way = room.middle - room.before_door;
    EXPECT_TRUE(std::isinf(walls.cast(room.before_door, way.normalized(), way.norm()).distance));
  }
}

TEST(BuildingPlan, AsManyPiecesAreMovedAsWereAskedFor) {
  BuildingPlan plan;
  const std::vector<Room> rooms = add_rooms(plan, {{0, 0}, {20, 0}});
  const std::vector<Piece> pieces = furnish(rooms, 3, Random(4));
  ASSERT_EQ(pieces.size(), 15U);
  EXPECT_EQ(differing(pieces, furnish(rooms, 3, Random(4))), 0U);
  for (const std::size_t count : {0U, 1U, 4U, 15U}) {
    EXPECT_EQ(differing(pieces, rearranged(pieces, rooms, count, Random(9))), count);
  }
  EXPECT_EQ(differing(pieces, rearranged(pieces, rooms, 99, Random(9))), 15U);
}

TEST(Buildings, LeaveRoomForTheRobotAllAlongTheRoute) {
  constexpr double kRobot = 0.25;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const World& world : {make_hospital(seed, 50), make_terminal(seed), make_warehouse(seed), make_dormitory(seed),
                               make_rotunda(seed)}) {
      const RayCaster walls(world.walls);
      const std::vector<Vector2d>& way = world.routes.front().points;
      for (std::size_t i = 0; i < way.size(); ++i) {
        const Vector2d step = way[(i + 1) % way.size()] - way[i];
        for (double share = 0; share < 1; share += 0.05) {
          EXPECT_GT(walls.clearance(way[i] + share * step, 1), kRobot) << world.name << " " << seed << " " << i;
        }
      }
    }
  }
}

}  // namespace
}  // namespace helicoid
