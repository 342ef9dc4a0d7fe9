#include "helicoid/exploration/frontiers.hpp"

#include <gmock/gmock.h>

#include "helicoid/navigation/distance_field.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;
using synthetic::Wall;

/// A patch at each pose, related to those before it that are near.
Builder survey(std::span<const Wall> walls, std::span<const Pose2> poses) {
  Builder builder;
  for (const Pose2& pose : poses) {
    const PatchId id = builder.add(walls, pose);
    for (std::uint32_t i = 0; i < id.value; ++i) {
      if ((builder.map.T_plane_patch(PatchId{i}).translation() - pose.translation()).norm() < 6) {
        builder.relate(PatchId{i}, id);
      }
    }
  }
  return builder;
}

/// Turning on the spot at each of the places.
std::vector<Pose2> looking_round(std::initializer_list<Vector2d> places) {
  std::vector<Pose2> poses;
  for (const Vector2d& p : places) {
    for (const double yaw : {0.0, 1.5, 3.0, -1.6}) poses.push_back({p.x(), p.y(), yaw});
  }
  return poses;
}

std::vector<Frontier> frontiers_of(const Map& map, const FrontierOptions& options = {}) {
  const Neighbours neighbours = find_neighbours(map);
  const NavigableMap navigable(map, neighbours);
  const DistanceField field = distances_from(navigable, ManifoldPose{make_id<PatchId>(0), {}});
  const Travel travel = [&](const ManifoldPoint& p) { return field.metres_to(p); };
  return find_frontiers(map, neighbours, {&travel, 1}, options);
}

/// A room of 8 m by 6 m with a door of this width in the middle of its right wall, into a room of 5 m by 6 m.
std::vector<Wall> two_rooms(double door) {
  std::vector<Wall> walls = {
      {{0, 0}, {8, 0}}, {{0, 6}, {8, 6}}, {{0, 0}, {0, 6}}, {{8, 0}, {8, 3 - door / 2}}, {{8, 3 + door / 2}, {8, 6}}};
  synthetic::append(walls, synthetic::rectangle(8, 0, 13, 6));
  walls.erase(walls.end() - 1);  // the second room's own left wall
  return walls;
}

TEST(Frontiers, AClosedRoomThatWasLookedAtHasNone) {
  const Builder builder = survey(synthetic::rectangle(0, 0, 8, 6), looking_round({{2, 2}, {6, 4}}));
  EXPECT_THAT(frontiers_of(builder.map), testing::IsEmpty());
}

TEST(Frontiers, APillarThatWasSeenFromAllSidesLeavesNone) {
  const Builder builder = survey(synthetic::pillar_room(), looking_round({{2, 3}, {4.5, 1}, {6.5, 3}, {4.5, 5}}));
  EXPECT_THAT(frontiers_of(builder.map), testing::IsEmpty());
}

TEST(Frontiers, WhatIsBehindARobotAtItsStartIsOne) {
  const std::vector<Pose2> one = {{3, 3, 0}};
  const Builder builder = survey(synthetic::rectangle(0, 0, 8, 6), one);
  const std::vector<Frontier> frontiers = frontiers_of(builder.map);
  ASSERT_FALSE(frontiers.empty());
  for (const Frontier& f : frontiers) {
    EXPECT_EQ(f.status, FrontierStatus::open);
    EXPECT_GT(std::abs(f.heading_patch), radians(90)) << "it looks back";
  }
}

TEST(Frontiers, AnOpenDoorIsTheWayToWhatLiesBehind) {
  const std::vector<Wall> walls = two_rooms(0.9);
  std::vector<Pose2> poses = looking_round({{7.3, 1}, {3, 3.5}, {7.2, 5}});
  double gain = 0;
  for (const Builder builder = survey(walls, poses); const Frontier& f : frontiers_of(builder.map)) {
    EXPECT_EQ(f.status, FrontierStatus::open);
    EXPECT_GT(project(builder.map, f.middle).x(), 7.8);
    EXPECT_GT(project(builder.map, f.goal).x(), 6.5);
    gain = std::max(gain, f.gain_m2);
  }
  EXPECT_GT(gain, 4) << "most of the next room";
  for (const Pose2& pose : looking_round({{7.6, 3}, {10, 1.5}, {10, 4.5}})) poses.push_back(pose);
  EXPECT_THAT(frontiers_of(survey(walls, poses).map), testing::IsEmpty());
}

TEST(Frontiers, AWallThatWasOnlySeenAlongItselfMayHaveADoorUntilItIsSeenFromNear) {
  // Wherever beams cross its line there is a return: of a wall, or of both posts of a door by halves.
  const std::vector<Wall> corridor = synthetic::rectangle(0, 0, 12, 2);
  std::vector<Pose2> poses = looking_round({{1, 1}});
  for (int i = 0; i < 20; ++i) poses.push_back({1 + 0.06 * i, 0.7 + 0.031 * i, 0});
  double gain = 0;
  for (const Builder builder = survey(corridor, poses); const Frontier& f : frontiers_of(builder.map)) {
    EXPECT_GT(project(builder.map, f.middle).x(), 4);
    gain = std::max(gain, f.gain_m2);
  }
  EXPECT_GT(gain, 4) << "there may be a room";
  for (const Pose2& pose : looking_round({{5, 1}, {8, 1}, {11, 1}})) poses.push_back(pose);
  EXPECT_THAT(frontiers_of(survey(corridor, poses).map), testing::IsEmpty());
}

TEST(Frontiers, WhatANeighbourCoversIsNoneAndWhatAnotherSheetCoversStillIs) {
  const std::vector<Wall> walls = synthetic::rectangle(0, 0, 8, 6);
  std::vector<Pose2> poses = {{3, 3, 0}};
  for (const Pose2& pose : looking_round({{2, 2}, {6, 4}})) poses.push_back(pose);
  EXPECT_THAT(frontiers_of(survey(walls, poses).map), testing::IsEmpty());
  // The same patches, but nothing is known of where the first lies among the others.
  Builder builder;
  for (const Pose2& pose : poses) builder.add(walls, pose);
  for (std::uint32_t i = 2; i < poses.size(); ++i) {
    for (std::uint32_t k = 1; k < i; ++k) builder.relate(PatchId{k}, PatchId{i});
  }
  builder.relate(PatchId{0}, PatchId{1}, RelationKind::odometry, {1, 1, 1});
  const std::vector<Frontier> frontiers = frontiers_of(builder.map);
  ASSERT_FALSE(frontiers.empty());
  for (const Frontier& f : frontiers) EXPECT_EQ(f.middle.patch, PatchId{0});
}

TEST(Frontiers, AnOpeningNarrowerThanTheRobotIsNoWay) {
  const Builder builder = survey(two_rooms(0.31), looking_round({{5, 3}, {7.2, 1}, {7.2, 5}}));
  for (const Frontier& f : frontiers_of(builder.map)) {
    // It may be looked at from before it, for much may lie behind.
    EXPECT_THAT(f.status, testing::AnyOf(FrontierStatus::too_narrow, FrontierStatus::from_near));
    EXPECT_TRUE(f.is_narrow);
    EXPECT_LT(f.opening, 0.40);
    EXPECT_LT(project(builder.map, f.goal).x(), f.status == FrontierStatus::from_near ? 8 : 13);
  }
}

TEST(Frontiers, WhatTheNearestPlaceDoesNotShowIsLookedAtFromAnotherOrOwnedUpTo) {
  // A doorway that robots passed close along its wall: its floor is known, and none of what lies behind.
  const Builder builder = survey(two_rooms(0.9), looking_round({{7.3, 0.6}, {7.3, 5.4}}));
  double most = 0;
  for (const Frontier& f : frontiers_of(builder.map)) {
    if (project(builder.map, f.middle).x() > 7.8) most = std::max(most, f.gain_m2);
  }
  EXPECT_GT(most, 4) << "most of the next room";
}

}  // namespace
}  // namespace helicoid
