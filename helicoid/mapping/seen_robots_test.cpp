#include "helicoid/mapping/seen_robots.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace helicoid {
namespace {

LaserModel laser() {
  LaserModel model;
  model.beams = 181;
  model.first_bearing = -std::numbers::pi / 2;
  model.bearing_step = radians(1);
  return model;
}

/// A wall all round at 6 m, and at 3 m ahead another robot half a metre wide.
Scan scan_with_robot_ahead() {
  Scan scan;
  scan.ranges.assign(181, 6.0F);
  for (int i = 86; i <= 94; ++i) scan.ranges[static_cast<std::size_t>(i)] = 2.8F;
  return scan;
}

Sighting ahead(double range) {
  return {"other", range, 0.0, std::nullopt, 0.03, 0.01, 0.03};
}

std::size_t without_return(const Scan& scan) {
  std::size_t count = 0;
  for (const float range : scan.ranges) count += std::isnan(range) ? 1 : 0;
  return count;
}

TEST(SeenRobots, AreNotInTheNextScanAndTheWallsAre) {
  SeenRobots seen;
  seen.see(Pose2{}, 10, ahead(3));
  const std::optional<ClearedScan> cleared = seen.clear(scan_with_robot_ahead(), 10.2, laser());
  ASSERT_TRUE(cleared.has_value());
  EXPECT_EQ(cleared->removed, 9U);
  EXPECT_EQ(without_return(cleared->scan), 9U);
}

TEST(SeenRobots, AreExpectedWhereTheyWentOnTo) {
  SeenRobots seen;
  // It comes nearer by half a metre a second.
  seen.see(Pose2{}, 9, ahead(3.9));
  seen.see(Pose2{}, 10, ahead(3.4));
  EXPECT_TRUE(seen.clear(scan_with_robot_ahead(), 11, laser()).has_value());
  SeenRobots standing;
  standing.see(Pose2{}, 10, ahead(3.9));
  EXPECT_FALSE(standing.clear(scan_with_robot_ahead(), 11, laser()).has_value());
}

TEST(SeenRobots, AreSeenFromWhereTheObserverHasDrivenTo) {
  SeenRobots seen;
  seen.see(Pose2{5, 1, 0}, 10, ahead(4));
  Scan scan = scan_with_robot_ahead();
  scan.T_odom_robot = {6, 1, 0};
  EXPECT_TRUE(seen.clear(scan, 10.5, laser()).has_value());
}

TEST(SeenRobots, AreForgottenSoon) {
  SeenRobots seen;
  seen.see(Pose2{}, 10, ahead(3));
  EXPECT_FALSE(seen.clear(scan_with_robot_ahead(), 12, laser()).has_value());
}

TEST(SeenRobots, NoPlaceFollowsFromABearingAlone) {
  SeenRobots seen;
  Sighting s = ahead(3);
  s.range.reset();
  seen.see(Pose2{}, 10, s);
  EXPECT_FALSE(seen.clear(scan_with_robot_ahead(), 10, laser()).has_value());
}

}  // namespace
}  // namespace helicoid
