#include "helicoid/navigation/kept_way.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_ring.hpp"

namespace helicoid {
namespace {

using synthetic::neighbours_of;
using synthetic::Ring;

/// A robot on its way from the ring's beginning to a place 6 m on, under which the map then winds up the sheet that
/// lies over the beginning.
struct WoundUp {
  static constexpr std::size_t kVouching = 12;
  Ring ring;
  ManifoldPoint goal{PatchId{4}, {0.2, 0}};
  ManifoldRoute way = plan_route(map(), {PatchId{0}, {}}, goal);

  [[nodiscard]] NavigableMap map() const {
    return NavigableMap(ring.builder.map, neighbours_of(ring.builder.map, kVouching));
  }
};

TEST(KeptWay, IsKeptByARobotUnderWhichAnotherSheetIsWoundUp) {
  const WoundUp robot;
  ASSERT_EQ(robot.way.status, RouteStatus::found);
  ASSERT_LT(robot.way.length, 8);
  const ManifoldRoute back = plan_route(robot.map(), robot.ring.last(), robot.goal);
  ASSERT_EQ(back.status, RouteStatus::found);
  ASSERT_GT(back.length, 40);
  EXPECT_TRUE(only_leads_back(robot.map(), robot.way, robot.way.length, back));
}

TEST(KeptWay, IsLeftForOneThatIsHardlyLonger) {
  const WoundUp robot;
  EXPECT_FALSE(only_leads_back(robot.map(), robot.way, robot.way.length - 1, robot.way));
}

TEST(KeptWay, IsLeftOnceSomethingBarsIt) {
  WoundUp robot;
  const ManifoldRoute back = plan_route(robot.map(), robot.ring.last(), robot.goal);
  std::vector<synthetic::Wall> walls = robot.ring.walls;
  synthetic::append(walls, {{{4.5, 0}, {4.5, 2}}});
  // More look at what stands there now than have looked through it.
  Neighbours neighbours = neighbours_of(robot.ring.builder.map, WoundUp::kVouching);
  for (const double x : {2.0, 3.0, 3.5, 4.0}) {
    const PatchId seen = robot.ring.builder.add(walls, {x, 1, 0});
    neighbours.emplace_back();
    for (std::uint32_t i = 0; i < 6; ++i) {
      neighbours[i].push_back(seen);
      neighbours.back().push_back(PatchId{i});
    }
  }
  const NavigableMap barred(robot.ring.builder.map, neighbours);
  EXPECT_FALSE(only_leads_back(barred, robot.way, robot.way.length, back));
}

}  // namespace
}  // namespace helicoid
