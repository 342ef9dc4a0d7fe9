// Robots that drive about in small buildings, for tests of how they are steered.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "helicoid/geometry/ray_casting.hpp"
#include "helicoid/navigation/route_follower.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid::synthetic {

constexpr double kDt = 0.1;
constexpr double kRadius = 0.20;

/// A robot's outline, or a person's.
inline std::vector<Wall> outline(const Vector2d& centre, double radius) {
  std::vector<Wall> sides;
  sides.reserve(12);
  const auto corner = [&](int k) {
    const double angle = radians(30.0 * k);
    return Vector2d(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  };
  for (int k = 0; k < 12; ++k) sides.push_back({corner(k), corner(k + 1)});
  return sides;
}

/// From a point to the nearest wall, metres, at most 10.
inline double clearance(std::span<const Wall> walls, const Vector2d& p_plane) {
  std::vector<Segment> segments;
  segments.reserve(walls.size());
  for (const Wall& wall : walls) segments.push_back({wall.from, wall.to});
  return std::min(10.0, RayCaster(segments).clearance(p_plane, 10));
}

struct Driver {
  Pose2 T_plane_robot;
  RouteFollower follower;
  Pose2 T_odom_robot = T_plane_robot;
  double snag = 1e9;  ///< beyond this x, which nobody sees, its wheels slip, metres
  DriveCommand wheels = {};
  FollowStep step = {};
  double closest = 10;  ///< to a wall or to another, metres
};

/// Robots that obey their limits in a building that the map knows.
struct Floor {
  std::vector<Wall> walls;
  Builder builder;
  std::vector<Wall> unknown;  ///< stands there, but is not in the map
  std::vector<Driver> drivers = {};

  [[nodiscard]] ManifoldPose on_map(const Pose2& pose) const {
    PatchId best{0};
    for (const PatchId id : builder.patches()) {
      const auto distance = [&](PatchId p) {
        return (builder.map.T_plane_patch(p).translation() - pose.translation()).norm();
      };
      if (distance(id) < distance(best)) best = id;
    }
    return {best, ominus(pose, builder.map.T_plane_patch(best))};
  }

  void send(const Pose2& from, const Vector2d& to, int right_of_way = 0) {
    const NavigableMap map(builder.map, neighbours_of(builder.map));
    FollowerOptions options;
    options.right_of_way = right_of_way;
    Driver driver{from, RouteFollower(options)};
    ManifoldRoute route = plan_route(map, on_map(from), point_of(on_map({to.x(), to.y(), 0})));
    ASSERT_EQ(route.status, RouteStatus::found);
    driver.follower.follow(std::move(route));
    drivers.push_back(std::move(driver));
  }

  void tick() {
    for (std::size_t i = 0; i < drivers.size(); ++i) {
      Driver& driver = drivers[i];
      std::vector<Wall> seen = walls;
      append(seen, unknown);
      for (std::size_t j = 0; j < drivers.size(); ++j) {
        if (j != i) append(seen, outline(drivers[j].T_plane_robot.translation(), kRadius));
      }
      Scan scan = take_scan(seen, driver.T_plane_robot, builder.laser);
      scan.T_odom_robot = driver.T_odom_robot;
      driver.step = driver.follower.step(builder.map, on_map(driver.T_plane_robot), scan, builder.laser, kDt);
      move(driver);
      driver.closest = std::min(driver.closest, clearance(seen, driver.T_plane_robot.translation()));
    }
  }
  static void move(Driver& driver) {
    const auto towards = [](double now, double wanted, double most) {
      return now + std::clamp(wanted - now, -most, most);
    };
    driver.wheels.speed = towards(driver.wheels.speed, driver.step.command.speed, 1.0 * kDt);
    driver.wheels.turn_rate = towards(driver.wheels.turn_rate, driver.step.command.turn_rate, 3.0 * kDt);
    const Pose2 motion = exponential(kDt * Vector3d(driver.wheels.speed, 0, driver.wheels.turn_rate));
    driver.T_odom_robot = driver.T_odom_robot * motion;
    const Pose2 after = driver.T_plane_robot * motion;
    if (after.x < driver.snag || after.x < driver.T_plane_robot.x) driver.T_plane_robot = after;
    driver.T_plane_robot.yaw = after.yaw;
  }
  /// Until all have arrived; how long that took, seconds.
  double run(double longest) {
    double now = 0;
    const auto done = [](const Driver& d) { return d.step.status == FollowStatus::arrived; };
    while (now < longest && !std::all_of(drivers.begin(), drivers.end(), done)) {
      tick();
      now += kDt;
    }
    return now;
  }
};

/// A building that was mapped from these poses.
inline Floor mapped_from(std::span<const Pose2> poses, std::vector<Wall> walls) {
  Floor floor{std::move(walls), Builder(), {}};
  for (const Pose2& pose : poses) floor.builder.add(floor.walls, pose);
  return floor;
}

/// Two rooms with a door of 0.9 m between them, one with a table.
inline Floor two_rooms() {
  std::vector<Wall> walls = rectangle(0, 0, 12, 5);
  append(walls, {{{6, 0}, {6, 2.55}}, {{6, 3.45}, {6, 5}}});
  append(walls, rectangle(8, 1.5, 9.5, 2.5));
  const Pose2 poses[] = {Pose2{1, 1, 0.5}, {1, 4, -0.5},  {4.5, 3, 0},  {4.5, 3, 3.1},
                         {7.5, 3, 0},      {7.5, 3, 3.1}, {11, 1, 2.0}, {11, 4, -2.5}};
  Floor floor = mapped_from(poses, walls);
  return floor;
}

/// A corridor that is known from either end.
inline Floor corridor(double width) {
  const std::vector<Wall> walls = rectangle(0, 0, 14, width);
  Floor floor{walls, Builder(), {}};
  for (double x = 1; x < 14; x += 2) {
    floor.builder.add(walls, {x, width / 2, 0});
    floor.builder.add(walls, {x, width / 2, 3.1});
  }
  return floor;
}

}  // namespace helicoid::synthetic
