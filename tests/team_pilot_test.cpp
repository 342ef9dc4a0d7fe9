// What robots of a team do about one another while they drive where they are told.
#include <gtest/gtest.h>

#include "apps/explore_run.hpp"
#include "tests/live_box.hpp"

namespace helicoid {
namespace {

/// A corridor of 1.1 m by 12 m, in which one robot can't pass another, with a niche 3 m from its beginning.
World corridor_with_niche() {
  World world;
  world.name = "corridor";
  const Vector2d corners[] = {{0, 0}, {12, 0}, {12, 1.1}, {4, 1.1}, {4, 2.3}, {3, 2.3}, {3, 1.1}, {0, 1.1}};
  for (int i = 0; i < 8; ++i) world.walls.push_back({corners[i], corners[(i + 1) % 8]});
  return world;
}

/// The first robot turns about until it sees the second one, and then has nothing to do; the second one is sent past
/// it.
TeamPilot::Planner past_the_first(double metres) {
  return [metres](double, const Map& map, const Neighbours&, std::span<const Travel> travel,
                  std::span<const TeamMember> members) {
    TeamPlan plan;
    for (const TeamMember& member : members) {
      plan.goals.push_back({member.robot, GoalKind::stay, point_of(member.pose), std::nullopt, "", 0});
    }
    if (map.islands().size() > 1 || members.size() < 2) {
      plan.goals[0] = {members[0].robot, GoalKind::operator_, members[0].home, radians(179), "", 0};
      return plan;
    }
    const ManifoldPoint there{members[0].home.patch, {metres, 0}};
    plan.goals[1] = {members[1].robot, GoalKind::operator_, there, std::nullopt, "", 0};
    plan.finished = travel[1](there) < 0.3;
    return plan;
  };
}

TEST(TeamPilot, ARobotWithNothingToDoMakesRoomForOneThatItBlocks) {
  // Ahead of the other one, or back to the niche, which the other one has to let it out to.
  for (const double metres : {4.0, 5.3}) {
    ExploreJob job;
    job.world = corridor_with_niche();
    job.robots = {{{6, 0.55, 0}}, {{3.5, 0.55, 0}}};
    job.planner = past_the_first(metres);
    job.longest = 200;
    const Result<ExploreRun> run = run_exploration(job);
    ASSERT_TRUE(run.has_value()) << run.error().message;
    EXPECT_TRUE(run->last_plan.finished) << metres;
    EXPECT_TRUE(run->contacts.empty());
  }
}

}  // namespace
}  // namespace helicoid
