#include "helicoid/navigation/moving_obstacles.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_floor.hpp"

namespace helicoid {
namespace {

using synthetic::kDt;
using synthetic::Wall;

/// A room with a pillar and a robot that drives through it as it likes; lasers are not perfect.
struct Walk {
  std::vector<Wall> walls = synthetic::pillar_room();
  LaserModel laser = synthetic::test_laser();
  Random random{7};
  MovingObstacles movers = {};

  void see(const Pose2& T_plane_robot, const std::optional<Vector2d>& p_walker = {}, bool has_odometry = true) {
    std::vector<Wall> seen = walls;
    if (p_walker) synthetic::append(seen, synthetic::outline(*p_walker, synthetic::kRadius));
    Scan scan = take_scan(seen, T_plane_robot, laser);
    for (float& range : scan.ranges) range += static_cast<float>(0.01 * random.normal());
    scan.has_odometry = has_odometry;
    // Odometry's frame is another than the plane's.
    scan.T_odom_robot = Pose2{3, -2, 1.1} * T_plane_robot;
    movers.see(scan, laser, kDt);
  }
};

TEST(MovingObstacles, AreNoWallsHoweverTheRobotDrivesAndTurns) {
  Walk walk;
  Pose2 T_plane_robot{1, 1, 0};
  for (int tick = 0; tick < 2000; ++tick) {
    // Straight on and in bends, and on the spot where something is near.
    const Vector2d p_ahead = T_plane_robot * Vector2d(0.1, 0);
    const bool turns = synthetic::clearance(walk.walls, p_ahead) < 0.3;
    const Vector3d twist = turns ? Vector3d(0, 0, 1.0) : Vector3d(0.6, 0, 0.8 * std::sin(0.02 * tick));
    T_plane_robot = T_plane_robot * exponential(kDt * twist);
    walk.see(T_plane_robot);
    EXPECT_TRUE(walk.movers.all().empty()) << tick;
  }
}

TEST(MovingObstacles, AreFoundWithTheirDirectionFromARobotThatDrives) {
  for (const double direction : {-2.6, -2.0, -1.2, 2.0, 2.6, 3.1}) {
    Walk walk;
    const Vector2d along(std::cos(direction), std::sin(direction));
    int found = 0;
    for (int tick = 0; tick < 20; ++tick) {
      const Pose2 T_plane_robot{1 + 0.04 * tick, 1, 0.02 * tick};
      const Vector2d p_plane_walker = Vector2d(2.6, 1.6) + 0.05 * (tick - 10) * along;
      walk.see(T_plane_robot, p_plane_walker);
      if (tick < 5) continue;
      ASSERT_LE(walk.movers.all().size(), 1U);
      if (walk.movers.all().empty()) continue;
      ++found;
      const MovingObstacle& mover = walk.movers.all().front();
      EXPECT_NEAR((T_plane_robot * mover.p_robot - p_plane_walker).norm(), synthetic::kRadius, 0.06);
      const double seen = std::atan2(mover.direction.y(), mover.direction.x()) + T_plane_robot.yaw;
      EXPECT_NEAR(wrap_angle(seen - direction), 0, 0.5) << direction;
    }
    EXPECT_GE(found, 13) << direction;
  }
}

TEST(MovingObstacles, StandStillWhereTheyStood) {
  Walk walk;
  for (int tick = 0; tick < 30; ++tick) {
    walk.see({1 + 0.05 * tick, 1, 0}, Vector2d(3, 2));
    EXPECT_TRUE(walk.movers.all().empty()) << tick;
  }
}

TEST(MovingObstacles, AreNotToldWithoutOdometry) {
  Walk walk;
  for (int tick = 0; tick < 30; ++tick) {
    walk.see({1, 1, 0}, Vector2d(3, 2 - 0.05 * tick), false);
    EXPECT_TRUE(walk.movers.all().empty());
  }
}

}  // namespace
}  // namespace helicoid
