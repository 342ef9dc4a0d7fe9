#include "helicoid/navigation/plan_route.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "helicoid/geometry/ray_casting.hpp"
#include "helicoid/navigation/distance_field.hpp"
#include "tests/synthetic_ring.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;
using synthetic::neighbours_of;
using synthetic::Ring;
using synthetic::Wall;

RayCaster casting(const std::vector<Wall>& walls) {
  std::vector<Segment> segments;
  segments.reserve(walls.size());
  for (const Wall& wall : walls) segments.push_back({wall.from, wall.to});
  return RayCaster(segments);
}

/// The least distance to a wall anywhere on the route.
double closest(const Map& map, const ManifoldRoute& route, const std::vector<Wall>& walls) {
  const RayCaster caster = casting(walls);
  double least = 10;
  for (std::size_t i = 1; i < route.points.size(); ++i) {
    const Vector2d from = project(map, route.points[i - 1]);
    const Vector2d to = project(map, route.points[i]);
    for (double share = 0; share <= 1; share += 0.02) {
      least = std::min(least, caster.clearance(from + share * (to - from), 10));
    }
  }
  return least;
}

/// Two rooms of 6 m by 5 m beside one another, with a door in the wall between them.
struct TwoRooms {
  std::vector<Wall> walls = synthetic::rectangle(0, 0, 12, 5);
  Builder builder;
  explicit TwoRooms(double door) {
    synthetic::append(walls, {{{6, 0}, {6, 3 - door / 2}}, {{6, 3 + door / 2}, {6, 5}}});
    for (const Pose2& pose : {Pose2{1, 1, 0.5}, {1, 1, 2.0}, {4.5, 3, 0}, {4.5, 3, 3.1}, {7.5, 3, 0}, {7.5, 3, 3.1}}) {
      builder.add(walls, pose);
    }
  }
  [[nodiscard]] ManifoldRoute route(const ManifoldPoint& goal) const {
    const NavigableMap map(builder.map, neighbours_of(builder.map));
    return plan_route(map, {PatchId{0}, {}}, goal);
  }
  /// A place in the far room.
  ManifoldPoint there{PatchId{4}, {2, -1}};
};

TEST(PlanRoute, LeadsThroughADoorThatIsWideEnough) {
  for (const double door : {0.9, 1.0, 1.2}) {
    const TwoRooms rooms(door);
    const ManifoldRoute route = rooms.route(rooms.there);
    ASSERT_EQ(route.status, RouteStatus::found) << door;
    const auto apart = [&](const ManifoldPoint& a, const ManifoldPoint& b) {
      return (project(rooms.builder.map, a) - project(rooms.builder.map, b)).norm();
    };
    EXPECT_LT(apart(route.points.front(), {PatchId{0}, {0, 0}}), 1e-9);
    EXPECT_LT(apart(route.points.back(), rooms.there), 1e-9);
    EXPECT_GE(closest(rooms.builder.map, route, rooms.walls), 0.25) << door;
    EXPECT_LE(route.length,
              1.15 * ((Vector2d(6, 3) - Vector2d(1, 1)).norm() + (Vector2d(9.5, 2) - Vector2d(6, 3)).norm()));
  }
}

TEST(PlanRoute, NeverLeadsThroughADoorThatIsTooNarrow) {
  const TwoRooms rooms(0.4);
  EXPECT_EQ(rooms.route(rooms.there).status, RouteStatus::unreachable);
}

TEST(PlanRoute, LeadsBackThroughWhereverARobotHasBeen) {
  // A door that is a little too narrow, as the map has it now; and yet a robot came through.
  TwoRooms rooms(0.48);
  EXPECT_EQ(rooms.route(rooms.there).status, RouteStatus::unreachable);
  for (double x = 5; x < 7.05; x += 0.05) rooms.builder.add(rooms.walls, {x, 3, 0});
  const ManifoldRoute route = rooms.route(rooms.there);
  ASSERT_EQ(route.status, RouteStatus::found);
  for (std::size_t i = 1; i < route.points.size(); ++i) {
    const Vector2d from = project(rooms.builder.map, route.points[i - 1]);
    const Vector2d to = project(rooms.builder.map, route.points[i]);
    if (from.x() < 6 && to.x() >= 6) {
      EXPECT_NEAR((from + (6 - from.x()) / (to.x() - from.x()) * (to - from)).y(), 3, 0.08);
    }
  }
  // Until it is shut.
  std::vector<Wall> shut = rooms.walls;
  shut.push_back({{6, 2}, {6, 4}});
  for (const double y : {1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5}) {
    for (int k = 0; k < 8; ++k) rooms.builder.add(shut, {4.5 + 0.1 * k, y, 0});
  }
  EXPECT_EQ(rooms.route(rooms.there).status, RouteStatus::unreachable);
}

TEST(PlanRoute, SaysWhatIsOffTheGround) {
  const TwoRooms rooms(0.9);
  EXPECT_EQ(rooms.route({PatchId{0}, {40, 0}}).status, RouteStatus::goal_off_ground);
  EXPECT_EQ(rooms.route({PatchId{99}, {0, 0}}).status, RouteStatus::goal_off_ground);
  const NavigableMap map(rooms.builder.map, neighbours_of(rooms.builder.map));
  EXPECT_EQ(plan_route(map, {PatchId{0}, {-30, 0, 0}}, rooms.there).status, RouteStatus::start_off_ground);
}

TEST(PlanRoute, KeepsAwayFromWhatIsClosedForNow) {
  std::vector<Wall> walls = synthetic::rectangle(0, 0, 12, 5);
  Builder builder;
  for (const Pose2& pose : {Pose2{1, 2.5, 0}, {11, 2.5, 3.1}}) builder.add(walls, pose);
  const NavigableMap map(builder.map, neighbours_of(builder.map));
  const ManifoldPose from{PatchId{0}, {}};
  const ManifoldPoint goal{PatchId{0}, {9, 0}};
  EXPECT_LT(plan_route(map, from, goal).length, 9.1);
  const ClosedFloor someone{{PatchId{0}, {4, 0}}, 0.8};
  const ManifoldRoute round = plan_route(map, from, goal, {&someone, 1});
  ASSERT_EQ(round.status, RouteStatus::found);
  for (std::size_t i = 1; i < round.points.size(); ++i) {
    const Vector2d a = project(builder.map, round.points[i - 1]);
    const Vector2d b = project(builder.map, round.points[i]);
    for (double share = 0; share <= 1; share += 0.05) EXPECT_GT((a + share * (b - a) - Vector2d(5, 2.5)).norm(), 0.74);
  }
  const ClosedFloor all_across{{PatchId{0}, {4, 0}}, 2.5};
  EXPECT_EQ(plan_route(map, from, goal, {&all_across, 1}).status, RouteStatus::unreachable);
}

TEST(PlanRoute, KeepsOutOfForbiddenFloorUnlessItStartsThere) {
  std::vector<Wall> walls = synthetic::rectangle(0, 0, 12, 5);
  Builder builder;
  for (const Pose2& pose : {Pose2{1, 2.5, 0}, {11, 2.5, 3.1}}) builder.add(walls, pose);
  NavigableMap map(builder.map, neighbours_of(builder.map));
  const ManifoldPose from{PatchId{0}, {}};
  const ManifoldPoint goal{PatchId{0}, {9, 0}};
  // Seen from the first patch, which stands at (1, 2.5): all across but for a metre on the left.
  const ForbiddenFloor region{PatchId{0}, {{3, -3}, {5, -3}, {5, 1.5}, {3, 1.5}}};
  map.forbid({&region, 1});
  EXPECT_TRUE(map.is_forbidden({PatchId{0}, {4, 0}}));
  const ManifoldRoute round = plan_route(map, from, goal);
  ASSERT_EQ(round.status, RouteStatus::found);
  EXPECT_GT(round.length, 9.4);
  EXPECT_NEAR(distances_from(map, from).metres_to(goal), round.length, 0.6);
  for (const ManifoldPoint& point : round.points) EXPECT_FALSE(map.is_forbidden(point));
  EXPECT_EQ(plan_route(map, {PatchId{0}, {4, 0, 0}}, goal).status, RouteStatus::found);
  const ForbiddenFloor all_across{PatchId{0}, {{3, -3}, {5, -3}, {5, 3}, {3, 3}}};
  map.forbid({&all_across, 1});
  EXPECT_EQ(plan_route(map, from, goal).status, RouteStatus::unreachable);
  map.forbid({});
  EXPECT_LT(plan_route(map, from, goal).length, 9.1);
}

/// A corridor of 1 m by 12 m with a niche of 1 m by 1.5 m on its left, 5 m along.
struct CorridorWithNiche {
  std::vector<Wall> walls{{{0, 0}, {12, 0}},    {{12, 0}, {12, 1}}, {{12, 1}, {6, 1}}, {{6, 1}, {6, 2.5}},
                          {{6, 2.5}, {5, 2.5}}, {{5, 2.5}, {5, 1}}, {{5, 1}, {0, 1}},  {{0, 1}, {0, 0}}};
  Builder builder;
  CorridorWithNiche() {
    for (const Pose2& pose : {Pose2{1, 0.5, 0}, {4, 0.5, 0}, {5.5, 0.5, 1.57}, {8, 0.5, 0}, {8, 0.5, 3.1}}) {
      builder.add(walls, pose);
    }
  }
  /// All along the corridor.
  std::vector<ManifoldPoint> way{
      {PatchId{0}, {0, 0}}, {PatchId{1}, {0, 0}}, {PatchId{3}, {0, 0}}, {PatchId{3}, {3.5, 0}}};
};

TEST(PlanRouteAside, LeadsToTheNearestPlaceThatTheOtherPassesBy) {
  const CorridorWithNiche corridor;
  const NavigableMap map(corridor.builder.map, neighbours_of(corridor.builder.map));
  const ManifoldPose parked{PatchId{3}, {-1, 0, 0}};
  const ManifoldRoute route = plan_route_aside(map, parked, corridor.way);
  ASSERT_EQ(route.status, RouteStatus::found);
  const Vector2d there = project(corridor.builder.map, route.points.back());
  EXPECT_NEAR(there.x(), 5.5, 0.3);
  EXPECT_NEAR(there.y(), 1.1, 0.15);
  EXPECT_GE(closest(corridor.builder.map, route, corridor.walls), 0.25);
}

TEST(PlanRouteAside, LeadsNowhereIfThereIsNoSuchPlaceOrTheOtherStandsInTheWay) {
  const CorridorWithNiche corridor;
  const NavigableMap map(corridor.builder.map, neighbours_of(corridor.builder.map));
  const ManifoldPose parked{PatchId{3}, {-1, 0, 0}};
  const ClosedFloor other{{PatchId{2}, {0, 0}}, 0.7};
  EXPECT_EQ(plan_route_aside(map, parked, corridor.way, {&other, 1}).status, RouteStatus::unreachable);
  AsideOptions near;
  near.farthest = 1;
  EXPECT_EQ(plan_route_aside(map, parked, corridor.way, {}, near).status, RouteStatus::unreachable);
  const ManifoldPose off{PatchId{0}, {-30, 0, 0}};
  EXPECT_EQ(plan_route_aside(map, off, corridor.way).status, RouteStatus::start_off_ground);
}

TEST(PlanRoute, KeepsItsClearanceInClutteredRooms) {
  Random random(5);
  int found = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<Wall> walls = synthetic::rectangle(0, 0, 14, 9);
    for (int i = 0; i < 14; ++i) {
      const Vector2d low(random.uniform(1, 12), random.uniform(1, 7));
      const Vector2d high = low + Vector2d(random.uniform(0.05, 1), random.uniform(0.05, 1));
      synthetic::append(walls, synthetic::rectangle(low.x(), low.y(), high.x(), high.y()));
    }
    const RayCaster caster = casting(walls);
    Builder builder;
    while (builder.map.patch_count() < 30) {
      const Pose2 pose{random.uniform(0.3, 13.7), random.uniform(0.3, 8.7), random.uniform(-3.1, 3.1)};
      if (caster.clearance(pose.translation(), 1) > 0.4) builder.add(walls, pose);
    }
    const NavigableMap map(builder.map, neighbours_of(builder.map));
    for (std::uint32_t i = 1; i < 30; ++i) {
      const ManifoldRoute route = plan_route(map, {PatchId{i - 1}, {}}, {PatchId{i}, {0, 0}});
      if (route.status != RouteStatus::found) continue;
      ++found;
      EXPECT_GE(closest(builder.map, route, walls), map.options().least_clearance())
          << "round " << round << ", to " << i;
    }
  }
  EXPECT_GT(found, 400);
}

TEST(PlanRoute, GoesTheLongWayRoundWhereSheetsLieOverOneAnother) {
  const Ring ring;
  const ManifoldPoint start{PatchId{0}, {0.2, 0}};
  const NavigableMap spiral(ring.builder.map, neighbours_of(ring.builder.map, 12));
  const ManifoldRoute long_way = plan_route(spiral, ring.last(), start);
  ASSERT_EQ(long_way.status, RouteStatus::found);
  EXPECT_GT(long_way.length, 55);
  EXPECT_NEAR(distances_from(spiral, ring.last()).metres_to(start), long_way.length, 0.1 * long_way.length);
  const NavigableMap closed(ring.builder.map, neighbours_of(ring.builder.map));
  const ManifoldRoute short_way = plan_route(closed, ring.last(), start);
  ASSERT_EQ(short_way.status, RouteStatus::found);
  EXPECT_LT(short_way.length, 8);
}

TEST(NavigableMap, IsTheSameWhetherItTakesOverFromTheOneBeforeOrNot) {
  const Ring ring;
  Builder growing;
  std::optional<NavigableMap> before;
  for (std::size_t i = 0; i < ring.builder.map.patch_count(); ++i) {
    growing.add(ring.walls, ring.builder.map.T_plane_patch(make_id<PatchId>(i)));
    if (i % 7 != 0) continue;
    const Neighbours neighbours = neighbours_of(growing.map, 12);
    const NavigableMap anew(growing.map, neighbours);
    before = NavigableMap(growing.map, neighbours, NavigationOptions{}, before ? &*before : nullptr);
    ASSERT_EQ(before->plan()->tiles.size(), anew.plan()->tiles.size());
    for (std::size_t k = 0; k < anew.plan()->tiles.size(); ++k) {
      EXPECT_EQ(before->plan()->tiles[k]->clearance, anew.plan()->tiles[k]->clearance);
    }
  }
}

TEST(DistanceField, IsInfiniteWhereNoRouteLeads) {
  const TwoRooms rooms(0.4);
  const NavigableMap map(rooms.builder.map, neighbours_of(rooms.builder.map));
  const DistanceField field = distances_from(map, ManifoldPose{PatchId{0}, {}});
  EXPECT_TRUE(std::isinf(field.metres_to(rooms.there)));
  EXPECT_NEAR(field.metres_to({PatchId{2}, {0, 0}}), (Vector2d(1, 1) - Vector2d(4.5, 3)).norm(), 0.4);
  EXPECT_TRUE(std::isinf(distances_from(map, ManifoldPose{PatchId{0}, {-30, 0, 0}}).metres_to(rooms.there)));
}

TEST(NavigableMap, ForgetsWhatMorePatchesLookThroughThanSaw) {
  const std::vector<Wall> room = synthetic::rectangle(0, 0, 8, 5);
  std::vector<Wall> with_someone = room;
  synthetic::append(with_someone, synthetic::rectangle(3.8, 2.3, 4.2, 2.7));
  Builder builder;
  builder.add(with_someone, {2, 2.5, 0});
  const ManifoldPoint there{PatchId{0}, {2, 0}};
  EXPECT_FALSE(NavigableMap(builder.map, neighbours_of(builder.map)).is_passable(there));
  for (const double x : {2.5, 3.0, 3.5}) builder.add(room, {x, 2.5, 0});
  EXPECT_TRUE(NavigableMap(builder.map, neighbours_of(builder.map)).is_passable(there));
}

TEST(NavigableMap, TakesNoRobotOfTheTeamForAnObstacle) {
  std::vector<Wall> walls = synthetic::rectangle(0, 0, 8, 5);
  synthetic::append(walls, synthetic::rectangle(3.9, 2.4, 4.1, 2.6));
  for (const bool is_robot : {false, true}) {
    Builder builder;
    MapEditor editor(builder.map);
    const RobotId other = editor.add_robot("robot2", {builder.laser});
    builder.add(walls, {2, 2.5, 0});
    const ManifoldPose there{PatchId{0}, {2, 0, 0}};
    const double then = builder.map.patch(PatchId{0}).stamp;
    // It stood there when the patch was made; or it has been there long before, and then something was put there.
    editor.append_scan(other, {is_robot ? then : then - 60, there, there.T_patch_robot, Matrix3d::Identity() * 1e-4});
    EXPECT_EQ(NavigableMap(builder.map, neighbours_of(builder.map)).is_passable(point_of(there)), is_robot);
  }
}

}  // namespace
}  // namespace helicoid
