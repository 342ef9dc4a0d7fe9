#include "helicoid/exploration/rendezvous.hpp"

#include <gmock/gmock.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;
using testing::IsEmpty;
using testing::SizeIs;

/// Two views of rooms that look alike, on sheets of their own: is the second where the first is?
struct TwoRooms {
  Builder builder;
  Doubt doubt;
  RendezvousDesk desk;
  std::vector<TeamMember> members;
  std::vector<Travel> travel;

  TwoRooms() {
    const auto walls = synthetic::rectangle(0, 0, 8, 6);
    const PatchId a = builder.add(walls, {1.5, 3, 0});
    const PatchId b = builder.add(walls, {1.5, 3, 0}, {31.5, 3, 0});
    doubt = {7, a, b, {{}, Matrix3d::Identity() * 1e-4}, 1};
    for (std::uint32_t i = 0; i < 2; ++i) {
      members.push_back({RobotId{i}, {i == 0 ? a : b, {0.5, 0, 1}}, true, 1, {a, Vector2d::Zero()}});
    }
    // Straight ways; the map is told anew at each call.
    for (std::size_t i = 0; i < 2; ++i) {
      travel.emplace_back([this, i](const ManifoldPoint& p) {
        return (project(builder.map, p) - builder.map.project(members[i].pose).translation()).norm();
      });
    }
  }
  Posts begin() {
    const Posts posts = *find_posts(builder.map, doubt, travel[1]);
    const std::vector<std::uint8_t> both(2, 1);
    desk.begin(0, builder.map, doubt, posts, *choose_pair(posts, doubt, travel, both), members);
    return posts;
  }
  void stand(const Posts& posts) {
    members[0].pose = {doubt.a, posts.T_a_watcher};
    members[1].pose = {doubt.b, posts.T_b_shown};
  }
  std::vector<Settled> step(double now) { return desk.step(now, builder.map, members, travel, {&doubt, 1}); }
};

TEST(Rendezvous, ThePostsAreInFullViewOfEachOtherIfThePlacesAreOne) {
  TwoRooms rooms;
  const std::optional<Posts> posts = find_posts(rooms.builder.map, rooms.doubt, rooms.travel[1]);
  ASSERT_TRUE(posts.has_value());
  EXPECT_GT(posts->chance, 0.95);
  EXPECT_GT(posts->T_b_shown.translation().norm(), 1.0) << "two robots need room";
}

TEST(Rendezvous, EachOfThePairGoesWhereItIsNearer) {
  TwoRooms rooms;
  rooms.begin();
  ASSERT_THAT(rooms.desk.meetings(), SizeIs(1));
  EXPECT_EQ(rooms.desk.meetings()[0].watcher_robot, RobotId{0});
  EXPECT_EQ(rooms.desk.meetings()[0].goal_of(RobotId{1}).point.patch, rooms.doubt.b);
}

TEST(Rendezvous, RobotsThatSeeEachOtherAtBothPlacesSettleThatTheyAreOne) {
  TwoRooms rooms;
  const Posts posts = rooms.begin();
  rooms.stand(posts);
  EXPECT_THAT(rooms.step(5), IsEmpty());
  rooms.desk.saw({5.5, RobotId{0}, RobotId{1}, posts.T_b_shown.translation().norm()});
  const std::vector<Settled> settled = rooms.step(6);
  ASSERT_THAT(settled, SizeIs(1));
  EXPECT_EQ(settled[0].outcome, MeetingOutcome::met);
  EXPECT_EQ(settled[0].doubt, 7U);
}

TEST(Rendezvous, ASightingOnTheWayOrOfAnotherDistanceSettlesNothing) {
  TwoRooms rooms;
  const Posts posts = rooms.begin();
  rooms.step(1);
  rooms.desk.saw({1.5, RobotId{0}, RobotId{1}, posts.T_b_shown.translation().norm()});
  rooms.stand(posts);
  EXPECT_THAT(rooms.step(2), IsEmpty());
  rooms.desk.saw({2.5, RobotId{0}, RobotId{1}, posts.T_b_shown.translation().norm() + 4});
  EXPECT_THAT(rooms.step(3), IsEmpty());
}

TEST(Rendezvous, RobotsThatWereSurelyThereAndSawNobodySettleThatThePlacesAreDistinctOnce) {
  TwoRooms rooms;
  const Posts posts = rooms.begin();
  rooms.stand(posts);
  std::vector<Settled> settled;
  double now = 5;
  for (; settled.empty() && now < 15; now += 1) settled = rooms.step(now);
  ASSERT_THAT(settled, SizeIs(1));
  EXPECT_EQ(settled[0].outcome, MeetingOutcome::absent);
  EXPECT_GE(settled[0].chance, 0.95);
  EXPECT_FALSE(rooms.desk.is_open(now + 1000, rooms.builder.map, rooms.doubt)) << "it is not asked again";
}

/// A robot's two rooms on an island each, 20 m apart on either.
struct TwoIslands {
  Builder builder;
  Doubt first, second;
  RendezvousDesk desk;
  std::vector<TeamMember> members;

  TwoIslands() {
    const auto walls = synthetic::rectangle(0, 0, 8, 6);
    const auto other_walls = synthetic::rectangle(20, 0, 26, 6);
    const PatchId a = builder.add(walls, {1.5, 3, 0});
    const PatchId other_a = builder.add(other_walls, {21.5, 3, 0});
    builder.island = MapEditor(builder.map).add_island();
    const PatchId b = builder.add(walls, {1.5, 3, 0}, {3, 1.5, std::numbers::pi / 2});
    const PatchId other_b = builder.add(other_walls, {21.5, 3, 0}, {3, 21.5, std::numbers::pi / 2});
    first = {7, a, b, {{}, Matrix3d::Identity() * 1e-4}, 1};
    second = {8, other_a, other_b, {{}, Matrix3d::Identity() * 1e-4}, 1};
    members = {{RobotId{0}, {a, {}}, true, 1, {a, Vector2d::Zero()}},
               {RobotId{1}, {b, {}}, true, 1, {b, Vector2d::Zero()}}};
    desk.begin(0, builder.map, first, {{}, {}, 1}, {0, 1, 5}, members);
  }
};

TEST(Rendezvous, DoubtsThatWouldJoinTwoIslandsAlikeAskTheSame) {
  TwoIslands two;
  EXPECT_FALSE(two.desk.is_open(1, two.builder.map, two.second));
  std::swap(two.second.a, two.second.b);
  EXPECT_FALSE(two.desk.is_open(1, two.builder.map, two.second));
  two.second.T_a_b.T_a_b.yaw = 1;
  EXPECT_TRUE(two.desk.is_open(1, two.builder.map, two.second));
}

/// The second island lies in the first one's plane as the first doubt has it, or aside.
void join(TwoIslands& two, const Pose2& T_a_aside = {}) {
  const Map& map = two.builder.map;
  const Pose2 T_into_from =
      map.T_plane_patch(two.first.a) * T_a_aside * two.first.T_a_b.T_a_b * map.T_plane_patch(two.first.b).inverse();
  MapEditor(two.builder.map).merge_islands(map.island_of(two.first.a), map.island_of(two.first.b), T_into_from);
}

/// What is settled while nobody has got to a post.
std::vector<Settled> settled_under_way(TwoIslands& two, std::span<const Doubt> open) {
  const std::vector<Travel> nobody(2, [](const ManifoldPoint&) { return HUGE_VAL; });
  return two.desk.step(2, two.builder.map, two.members, nobody, open);
}

TEST(Rendezvous, IslandsThatAreJoinedAsTheDoubtHasItSettleThatThePlacesAreOne) {
  for (const bool is_open : {true, false}) {  // or the map has taken the doubt itself by then
    TwoIslands two;
    two.desk.saw({1.5, RobotId{1}, RobotId{4}, 3.0, true});
    join(two);
    const std::vector<Settled> settled = settled_under_way(two, {&two.first, is_open ? 1U : 0U});
    ASSERT_THAT(settled, SizeIs(1)) << is_open;
    EXPECT_EQ(settled[0].outcome, MeetingOutcome::met);
    EXPECT_FALSE(settled[0].by_chance) << "one of the pair was seen";
    EXPECT_THAT(two.desk.meetings(), IsEmpty());
  }
}

TEST(Rendezvous, ADoubtThatIsGoneIsNotMetAboutAndNothingIsSettled) {
  for (const bool are_joined : {false, true}) {  // otherwise than the doubt has it
    TwoIslands two;
    if (are_joined) join(two, {4, 0, 0});
    EXPECT_THAT(settled_under_way(two, {}), IsEmpty());
    EXPECT_THAT(two.desk.meetings(), IsEmpty());
  }
}

TEST(Rendezvous, AbsenceDoesNotCountWhereTheRobotMightHaveBeenOutOfView) {
  TwoRooms rooms;
  rooms.doubt.T_a_b.covariance = Vector3d(4, 4, 0.5).asDiagonal();
  const Posts posts = rooms.begin();
  rooms.stand(posts);
  for (double now = 5; now < 20; now += 1) EXPECT_THAT(rooms.step(now), IsEmpty());
}

TEST(Rendezvous, AbsenceDoesNotCountWhereTheMapDoesNotKnowWhereTheRobotStood) {
  TwoRooms rooms;
  const PatchId beside = rooms.builder.add(synthetic::rectangle(0, 0, 8, 6), {1.5, 3, 0});
  const Posts posts = rooms.begin();
  rooms.stand(posts);
  rooms.members[0].pose.patch = beside;
  for (double now = 5; now < 20; now += 1) EXPECT_THAT(rooms.step(now), IsEmpty()) << "no relation ties it down";
}

TEST(StandingBeside, IsAsSureAsTheMapIsOfWhereTheRobotsPatchLies) {
  const StandingNoise on_its_sheet;
  double before = on_its_sheet.position;
  for (const double information : {1e4, 100.0, 1.0}) {
    Builder builder;
    const auto walls = synthetic::rectangle(0, 0, 8, 6);
    const PatchId a = builder.add(walls, {1.5, 3, 0});
    const PatchId b = builder.add(walls, {1.5, 3, 0});
    const PatchId loose = builder.add(walls, {1.5, 3, 0});
    EXPECT_EQ(standing_beside(builder.map, a, {a, {}}, on_its_sheet)->position, on_its_sheet.position);
    EXPECT_FALSE(standing_beside(builder.map, a, {b, {}}, on_its_sheet).has_value()) << "no relation ties them";
    builder.relate(a, b, RelationKind::overlap, Vector3d::Constant(information));
    builder.relate(b, loose);
    const StandingNoise noise = *standing_beside(builder.map, a, {b, {}}, on_its_sheet);
    EXPECT_GT(noise.position, before);
    EXPECT_GT(noise.position, std::sqrt(1 / information));
    EXPECT_GT(noise.heading, on_its_sheet.heading);
    before = noise.position;
  }
}

TEST(Rendezvous, AMeetingThatDoesNotComeAboutIsGivenUpAfterAFewTries) {
  TwoRooms rooms;
  double now = 0;
  const RendezvousOptions options;
  for (int round = 0; round < options.most_tries; ++round) {
    ASSERT_TRUE(rooms.desk.is_open(now, rooms.builder.map, rooms.doubt));
    const Posts posts = *find_posts(rooms.builder.map, rooms.doubt, rooms.travel[1]);
    rooms.desk.begin(now, rooms.builder.map, rooms.doubt, posts, {0, 1, 5}, rooms.members);
    now += 1000;
    EXPECT_THAT(rooms.step(now), IsEmpty());
    EXPECT_THAT(rooms.desk.meetings(), IsEmpty());
    now += options.rest + 1;
  }
  EXPECT_FALSE(rooms.desk.is_open(now, rooms.builder.map, rooms.doubt));
  EXPECT_FALSE(rooms.desk.is_resting(now, rooms.doubt));
}

}  // namespace
}  // namespace helicoid
