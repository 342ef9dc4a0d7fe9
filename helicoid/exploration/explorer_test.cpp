#include "helicoid/exploration/explorer.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "helicoid/navigation/distance_field.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;
using testing::Each;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

/// A hall that was seen in part, and robots in it.
struct Hall {
  Builder builder;
  std::vector<synthetic::Wall> walls = synthetic::rectangle(0, 0, 40, 6);
  std::vector<TeamMember> members;
  Explorer explorer;
  double now = 0;

  void see(const std::vector<Pose2>& poses) {
    for (const Pose2& pose : poses) {
      const PatchId id = builder.add(walls, pose);
      for (std::uint32_t i = 0; i < id.value; ++i) builder.relate(PatchId{i}, id);
    }
  }
  void look_round(double x) {
    for (const double yaw : {0.0, 1.5, 3.0, -1.6}) see({{x, 3, yaw}});
  }
  void put(const Pose2& pose) {
    const auto robot = make_id<RobotId>(members.size());
    PatchId nearest{0};
    for (const PatchId id : builder.patches()) {
      const auto far = [&](PatchId p) {
        return (builder.map.T_plane_patch(p).translation() - pose.translation()).norm();
      };
      if (far(id) < far(nearest)) nearest = id;
    }
    const Pose2 T_patch_robot = builder.map.T_plane_patch(nearest).inverse() * pose;
    members.push_back({robot, {nearest, T_patch_robot}, true, 1, {nearest, T_patch_robot.translation()}});
  }
  TeamPlan plan(std::vector<Order> orders = {}) {
    now += 1;
    const Neighbours neighbours = find_neighbours(builder.map);
    const NavigableMap floor(builder.map, neighbours);
    std::vector<DistanceField> fields;
    std::vector<Travel> travel;
    fields.reserve(members.size());
    for (const TeamMember& m : members) {
      fields.push_back(distances_from(floor, m.pose));
      travel.emplace_back([&fields, i = fields.size() - 1](const ManifoldPoint& p) { return fields[i].metres_to(p); });
    }
    return explorer.plan(now, builder.map, neighbours, travel, members, {}, orders);
  }
};

/// The middle of a long hall was seen: there is more to see at either end.
Hall half_seen_hall() {
  Hall hall;
  hall.look_round(20);
  return hall;
}

Order order(OrderKind kind) {
  Order order;
  order.kind = kind;
  return order;
}

TEST(Explorer, TwoRobotsGoEitherWay) {
  Hall hall = half_seen_hall();
  hall.put({19.5, 3, 0});
  hall.put({20.5, 3, 0});
  const TeamPlan plan = hall.plan();
  EXPECT_THAT(plan.goals, Each(Field(&Goal::kind, GoalKind::frontier)));
  EXPECT_LT(project(hall.builder.map, plan.goals[0].point).x(), 15);
  EXPECT_GT(project(hall.builder.map, plan.goals[1].point).x(), 25);
  EXPECT_EQ(plan.end_state, EndState::exploring);
}

TEST(Explorer, WhereAllIsKnownTheTeamGoesHomeAndIsDone) {
  Hall hall;
  for (const double x : {3.0, 12.0, 20.0, 28.0, 37.0}) hall.look_round(x);
  hall.put({20, 3, 0});
  hall.members[0].home = {PatchId{0}, Vector2d::Zero()};
  const TeamPlan on_the_way = hall.plan();
  EXPECT_THAT(on_the_way.frontiers, IsEmpty());
  EXPECT_EQ(on_the_way.goals[0].kind, GoalKind::home);
  EXPECT_EQ(on_the_way.end_state, EndState::returning);
  hall.members[0].pose = {PatchId{0}, {}};
  const TeamPlan home = hall.plan();
  EXPECT_TRUE(home.finished);
  EXPECT_EQ(home.end_state, EndState::explored);
  EXPECT_THAT(home.reason, HasSubstr("no frontier is left"));
}

TEST(Explorer, SaysThatARobotSeesNoWayHome) {
  Hall hall;
  for (const double x : {3.0, 12.0, 20.0, 28.0, 37.0}) hall.look_round(x);
  hall.put({20, 3, 0});
  hall.members[0].home = {PatchId{0}, {0, 90}};
  TeamPlan plan = hall.plan();
  EXPECT_EQ(plan.end_state, EndState::returning);
  for (int i = 0; i < 100 && !plan.finished; ++i) plan = hall.plan();
  EXPECT_EQ(plan.end_state, EndState::explored);
  EXPECT_THAT(plan.reason, HasSubstr("not everybody got home"));
}

TEST(Explorer, AForbiddenRegionIsNeverAGoal) {
  Hall hall = half_seen_hall();
  hall.put({20, 3, 0});
  Order forbid = order(OrderKind::forbid);
  forbid.point = {PatchId{0}, Vector2d::Zero()};
  forbid.region_patch = {{1, -4}, {30, -4}, {30, 4}, {1, 4}};  // all that lies ahead of the first patch
  const TeamPlan plan = hall.plan({forbid});
  ASSERT_EQ(plan.goals[0].kind, GoalKind::frontier);
  EXPECT_LT(project(hall.builder.map, plan.goals[0].point).x(), 20);
  EXPECT_THAT(plan.frontiers_left, testing::Contains(Field(&FrontierLeft::reason, "forbidden")));
}

TEST(Explorer, APausedTeamStandsStillAndIsNotDone) {
  Hall hall = half_seen_hall();
  hall.put({20, 3, 0});
  const TeamPlan paused = hall.plan({order(OrderKind::pause)});
  EXPECT_EQ(paused.goals[0].kind, GoalKind::operator_);
  EXPECT_FALSE(paused.finished);
  EXPECT_EQ(hall.plan({order(OrderKind::resume)}).goals[0].kind, GoalKind::frontier);
}

TEST(Explorer, ALowBatteryIsTakenHomeAndStaysThere) {
  Hall hall = half_seen_hall();
  hall.put({24, 3, 0});
  hall.members[0].home = {PatchId{0}, Vector2d::Zero()};
  hall.members[0].battery = 0.101;
  const TeamPlan plan = hall.plan();
  EXPECT_EQ(plan.goals[0].kind, GoalKind::home);
  EXPECT_EQ(plan.goals[0].reason, "low battery");
  hall.members[0].pose = {PatchId{0}, {}};
  const TeamPlan home = hall.plan();
  EXPECT_TRUE(home.finished);
  EXPECT_EQ(home.end_state, EndState::stopped);
}

TEST(Explorer, ARobotThatComesNoNearerTriesSomethingElse) {
  Hall hall = half_seen_hall();
  hall.put({20, 3, 0});
  const auto goes_to = [&] { return project(hall.builder.map, hall.plan().goals[0].point).x(); };
  const double first = goes_to();
  std::vector<double> later;
  later.reserve(100);
  for (int i = 0; i < 35; ++i) later.push_back(goes_to());
  EXPECT_THAT(later, testing::Contains(testing::Not(testing::DoubleNear(first, 0.5))));
  for (int i = 0; i < 65; ++i) later.push_back(goes_to());
  const auto is_other_end = [&](double x) { return std::abs(x - 20) > 5 && (x - 20) * (first - 20) < 0; };
  EXPECT_TRUE(std::any_of(later.begin(), later.end(), is_other_end));
}

TEST(Explorer, WhatIsLookedAtInVainIsLetBe) {
  Hall hall = half_seen_hall();
  hall.put({20, 3, 0});
  // A robot that is wherever it is sent, and a map that never grows.
  TeamPlan plan = hall.plan();
  for (int i = 0; i < 400 && !plan.finished; ++i) {
    const Goal& goal = plan.goals[0];
    hall.members[0].pose = {goal.point.patch, {goal.point.p_patch.x(), goal.point.p_patch.y(), 0}};
    plan = hall.plan();
  }
  EXPECT_TRUE(plan.finished) << "exploring ends";
  EXPECT_THAT(plan.reason, HasSubstr("in vain"));
}

}  // namespace
}  // namespace helicoid
