#include "helicoid/mapping/lay_out.hpp"

#include <gtest/gtest.h>

#include "helicoid/mapping/mapper.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

const Matrix3d kKnown = 1e4 * Matrix3d::Identity();

TEST(LayOut, PutsMapsSideBySideOnOneIsland) {
  const synthetic::Builder room = synthetic::pillar_map();
  const std::size_t patches = room.map.patch_count();
  const PlacedMap maps[] = {{&room.map, "a", {}}, {&room.map, "b", {20, 0, 0.5}}};
  const Passage passages[] = {{0, 1, PatchId{0}, PatchId{3}, kKnown}};
  const Map campus = lay_out(maps, passages);
  ASSERT_EQ(campus.patch_count(), 2 * patches);
  EXPECT_EQ(campus.islands().size(), 1U);
  EXPECT_EQ(campus.relations().size(), 2 * room.map.relations().size() + 1);
  ASSERT_EQ(campus.robots().size(), 2U);
  EXPECT_EQ(campus.robots()[1].name, "b-robot1");
  for (std::size_t i = 0; i < patches; ++i) {
    const Pose2 there = maps[1].T_plane_map * room.map.T_plane_patch(make_id<PatchId>(i));
    EXPECT_EQ(campus.T_plane_patch(make_id<PatchId>(patches + i)), there);
  }
}

TEST(LayOut, OfMapsOfOneNameHasTheirRobotsOnce) {
  const synthetic::Builder room = synthetic::pillar_map();
  const PlacedMap maps[] = {{&room.map, "a", {}}, {&room.map, "a", {20, 0, 0}}};
  const Map campus = lay_out(maps, {});
  ASSERT_EQ(campus.robots().size(), 1U);
  EXPECT_EQ(campus.robots()[0].trajectory.size(), 2 * room.map.patch_count());
  EXPECT_EQ(campus.patch(make_id<PatchId>(room.map.patch_count())).scan_index, room.map.patch_count());
}

TEST(Mapper, GoesOnFromAMapWhereItsRobotsStand) {
  const synthetic::Builder room = synthetic::pillar_map();
  Mapper mapper(MapperOptions{}, room.map);
  const PatchId last = make_id<PatchId>(room.map.patch_count() - 1);
  const Pose2 T_plane_robot = room.map.T_plane_patch(last);
  Event event;
  event.robot = room.robot;
  event.stamp = 2e9;
  event.body = synthetic::take_scan(synthetic::pillar_room(), T_plane_robot, room.laser);
  const Step step = mapper.process(event);
  EXPECT_EQ(step.status, StepStatus::matched);
  EXPECT_LT((T_plane_robot.inverse() * mapper.map().project(step.pose)).distance(), 0.01);
  EXPECT_EQ(mapper.map().islands().size(), 1U);
}

}  // namespace
}  // namespace helicoid
