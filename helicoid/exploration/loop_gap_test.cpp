#include "helicoid/exploration/loop_gap.hpp"

#include <gmock/gmock.h>

#include "helicoid/exploration/explorer.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;
using testing::HasSubstr;
using testing::IsEmpty;

/// A corridor of 3 m about a block, driven round from one place to another that lies 4 m short of it.
struct Ring {
  Builder builder;
  std::vector<PatchId> places;  ///< the last look of each
  std::vector<TeamMember> members;
  std::vector<Travel> travel;
  std::vector<double> range;
  LoopGapDesk desk;
  Neighbours neighbours;

  explicit Ring(double sigma) {
    std::vector<synthetic::Wall> walls = synthetic::rectangle(0, 0, 16, 16);
    synthetic::append(walls, synthetic::rectangle(3, 3, 13, 13));
    const double s2 = sigma * sigma;
    const Vector3d drift(1 / s2, 1 / s2, 9 / s2);
    for (const Vector2d& p :
         {Vector2d(6, 1.5), Vector2d(1.5, 1.5), Vector2d(1.5, 8), Vector2d(1.5, 14.5), Vector2d(8, 14.5),
          Vector2d(14.5, 14.5), Vector2d(14.5, 8), Vector2d(14.5, 1.5), Vector2d(10, 1.5)}) {
      PatchId before = places.empty() ? PatchId{} : places.back();
      for (const double yaw : {0.0, 1.5, 3.1, -1.6}) {
        const PatchId id = builder.add(walls, {p.x(), p.y(), yaw});
        if (!places.empty() || id.value > 0) {
          const bool arrives = yaw == 0.0;
          builder.relate(arrives ? before : PatchId{id.value - 1}, id, RelationKind::overlap,
                         arrives ? drift : Vector3d(1e7, 1e7, 1e8));
        }
        if (yaw == -1.6) places.push_back(id);
      }
    }
    neighbours = find_neighbours(builder.map);
  }
  void close() {
    builder.relate(places.front(), places.back(), RelationKind::closure, {1e5, 1e5, 1e6});
    neighbours = find_neighbours(builder.map);
  }
  /// As the crow flies: the robots are within sight.
  void put(const Vector2d& p, double metres) {
    const auto robot = make_id<RobotId>(members.size());
    const Vector2d p_patch = builder.map.T_plane_patch(places[0]).inverse() * p;
    members.push_back({robot, {places[0], {p_patch.x(), p_patch.y(), 0}}, true, 1, {places[0], Vector2d::Zero()}});
    range.push_back(metres);
    travel.emplace_back([this, i = members.size() - 1](const ManifoldPoint& to) {
      return (project(builder.map, to) - builder.map.project(members[i].pose).translation()).norm();
    });
  }
  void step(double now, bool other_work = false) {
    desk.step(now, builder.map, neighbours, members, travel, range, other_work);
  }
  std::optional<Goal> goal() { return desk.goal_of(RobotId{0}); }
};

constexpr double kDrift = 0.03;

TEST(LoopGap, IsWhereBothEndsOfALongWaySeeTheSameFloor) {
  const Ring ring(kDrift);
  const std::vector<LoopGap> gaps = find_loop_gaps(ring.builder.map, ring.neighbours);
  ASSERT_FALSE(gaps.empty());
  for (const LoopGap& gap : gaps) {
    EXPECT_GT(gap.way_round, 20);
    EXPECT_GT(gap.known_to, 0.1);
    const Vector2d goal = project(ring.builder.map, gap.goal);
    const Vector2d beyond = ring.builder.map.T_plane_patch(gap.beyond).translation();
    EXPECT_LT((goal - beyond).norm(), 10);
    EXPECT_TRUE(is_ground(ring.builder.map.patch(gap.from), gap.goal.p_patch));
  }
}

TEST(LoopGap, ThereIsNoneOnceTheLoopIsClosed) {
  Ring ring(kDrift);
  ring.close();
  EXPECT_THAT(find_loop_gaps(ring.builder.map, ring.neighbours), IsEmpty());
}

TEST(LoopGap, ThereIsNoneWhereTheLongWayIsWellKnown) {
  const Ring ring(kDrift / 20);
  EXPECT_THAT(find_loop_gaps(ring.builder.map, ring.neighbours), IsEmpty());
}

TEST(LoopGap, ARobotIsSentAcrossAndToldWhy) {
  Ring ring(kDrift);
  ring.put({6, 1.5}, 500);
  ring.step(0);
  ASSERT_TRUE(ring.goal().has_value());
  EXPECT_EQ(ring.goal()->kind, GoalKind::revisit);
  EXPECT_THAT(ring.goal()->reason, HasSubstr("two parts of the map"));
  EXPECT_THAT(ring.desk.left_in_words(), HasSubstr("known only to"));
}

TEST(LoopGap, WhoIsSentComesFromTheOneSideAndStandsOnTheOther) {
  Ring ring(kDrift);
  ring.put({6, 1.5}, 500);
  ring.step(0);
  ASSERT_TRUE(ring.goal().has_value());
  const auto near_start = [&](const Vector2d& p) { return (p - Vector2d(6, 1.5)).norm(); };
  EXPECT_LT(near_start(ring.builder.map.T_plane_patch(ring.goal()->point.patch).translation()), 6);
  EXPECT_GT(near_start(project(ring.builder.map, ring.goal()->point)), 2);
}

TEST(LoopGap, NobodyIsSentWhileThereIsOtherWork) {
  Ring ring(kDrift);
  ring.put({6, 1.5}, 500);
  ring.step(0, true);
  EXPECT_FALSE(ring.goal().has_value());
}

TEST(LoopGap, WhoCouldNotGetHomeFromThereIsNotSent) {
  Ring ring(kDrift);
  ring.put({1.5, 8}, 5);
  ring.put({1.5, 8}, -1);
  ring.step(0);
  EXPECT_FALSE(ring.goal().has_value());
  EXPECT_FALSE(ring.desk.goal_of(RobotId{1}).has_value());
}

TEST(LoopGap, FartherThanItIsWorthNobodyIsSent) {
  Ring ring(kDrift);
  ring.put({3000, 1.5}, 1e6);
  ring.step(0);
  EXPECT_FALSE(ring.goal().has_value());
}

TEST(LoopGap, NobodyIsNeededAnyMoreOnceTheLoopIsClosed) {
  Ring ring(kDrift);
  ring.put({6, 1.5}, 500);
  ring.step(0);
  ASSERT_TRUE(ring.goal().has_value());
  ring.close();
  ring.step(1);
  EXPECT_FALSE(ring.goal().has_value());
  EXPECT_THAT(ring.desk.left_in_words(), IsEmpty());
}

TEST(LoopGap, APlaceIsTriedAFewTimesAndThenLetBe) {
  Ring ring(kDrift);
  ring.put({6, 1.5}, 500);
  // A robot that is wherever it is sent, and a map that does not learn from it.
  int sent = 0;
  double now = 0;
  std::optional<PatchId> towards;
  for (; now < 1000; now += 1) {
    ring.step(now);
    const std::optional<Goal> goal = ring.goal();
    if (goal && towards != goal->point.patch) ++sent;
    towards = goal ? std::optional(goal->point.patch) : std::nullopt;
    if (!goal) break;
    ring.members[0].pose = {goal->point.patch, {goal->point.p_patch.x(), goal->point.p_patch.y(), 0}};
  }
  EXPECT_GE(sent, 1);
  EXPECT_LT(now, 200) << "it ends";
  EXPECT_THAT(ring.desk.left_in_words(), HasSubstr("left where parts of the map meet"));
}

TEST(LoopGap, TheTeamClosesTheLoopBeforeItGoesHomeAndOwnsUpIfItDoesNot) {
  Ring ring(kDrift);
  ring.put({6, 1.5}, 500);
  Explorer explorer;
  TeamPlan plan;
  bool revisits = false;
  for (double now = 1; now < 1000 && !plan.finished; now += 1) {
    plan = explorer.plan(now, ring.builder.map, ring.neighbours, ring.travel, ring.members, {}, {});
    const Goal& goal = plan.goals[0];
    revisits = revisits || goal.kind == GoalKind::revisit;
    EXPECT_TRUE(revisits || goal.kind != GoalKind::home);
    ring.members[0].pose = {goal.point.patch, {goal.point.p_patch.x(), goal.point.p_patch.y(), 0}};
  }
  EXPECT_TRUE(revisits);
  EXPECT_TRUE(plan.finished);
  EXPECT_THAT(plan.reason, HasSubstr("parts of the map meet"));
}

}  // namespace
}  // namespace helicoid
