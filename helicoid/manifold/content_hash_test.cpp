#include "helicoid/manifold/content_hash.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

Map sample() {
  return synthetic::random_map(7, 12, 40, 20);
}

TEST(ContentHash, IsEqualForEqualMaps) {
  EXPECT_EQ(content_hash(sample()), content_hash(sample()));
}

TEST(ContentHash, HasThirtyTwoDigits) {
  EXPECT_EQ(content_hash(Map{}).hex().size(), 32U);
}

TEST(ContentHash, ChangesWithThePoseOfAPatchByOneBit) {
  Map map = sample();
  Pose2 pose = map.T_plane_patch(PatchId{3});
  pose.x = std::nextafter(pose.x, 100.0);
  MapEditor(map).set_pose(PatchId{3}, pose);
  EXPECT_NE(content_hash(map), content_hash(sample()));
}

TEST(ContentHash, TellsMinusZeroFromZero) {
  Map a = sample();
  Map b = sample();
  MapEditor(a).set_pose(PatchId{0}, {0.0, 0, 0});
  MapEditor(b).set_pose(PatchId{0}, {-0.0, 0, 0});
  EXPECT_NE(content_hash(a), content_hash(b));
}

TEST(ContentHash, ChangesWithATrackedScan) {
  Map a = sample();
  Map b = sample();
  TrackedScan scan = a.robot(RobotId{1}).trajectory[0];
  MapEditor(a).append_scan(RobotId{1}, scan);
  scan.covariance(2, 2) = 2 * scan.covariance(2, 2) + 1e-9;
  MapEditor(b).append_scan(RobotId{1}, scan);
  EXPECT_NE(content_hash(a), content_hash(b));
}

TEST(ContentHash, ChangesWithAnEmptyIsland) {
  Map map = sample();
  MapEditor(map).add_island();
  EXPECT_NE(content_hash(map), content_hash(sample()));
}

TEST(ContentHash, ChangesWithTheOrderOfRelations) {
  Map a = sample();
  Map b = sample();
  const Relation first = a.relations()[0];
  const Relation second = a.relations()[1];
  MapEditor(a).add_relation(first);
  MapEditor(a).add_relation(second);
  MapEditor(b).add_relation(second);
  MapEditor(b).add_relation(first);
  EXPECT_NE(content_hash(a), content_hash(b));
}

}  // namespace
}  // namespace helicoid
