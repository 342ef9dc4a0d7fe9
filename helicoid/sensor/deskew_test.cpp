#include "helicoid/sensor/deskew.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "helicoid/sensor/scan_points.hpp"
#include "tests/simulated_view.hpp"

namespace helicoid {
namespace {

using synthetic::lms200;
using synthetic::look;
using synthetic::visible;

std::vector<Segment> room() {
  return {{{-3, -4}, {6, -4}}, {{6, -4}, {6, 5}}, {{6, 5}, {-3, 5}}, {{-3, 5}, {-3, -4}}};
}

/// A sweep that ends at T_world_robot, beam after beam, while the robot moves with the twist.
Scan sweep(const RayCaster& walls, const LaserModel& laser, const Pose2& T_world_robot, const Pose2& T_robot_laser,
           const Vector3d& twist) {
  Scan scan;
  scan.T_robot_laser = T_robot_laser;
  for (int beam = 0; beam < laser.beams; ++beam) {
    const double before_end = laser.scan_duration * (1 - static_cast<double>(beam) / (laser.beams - 1));
    const Pose2 T_world_laser = T_world_robot * exponential(-before_end * twist) * T_robot_laser;
    scan.ranges.push_back(static_cast<float>(visible(walls, T_world_laser, laser.bearing(beam))));
  }
  return scan;
}

double largest_error(const Scan& a, const Scan& b) {
  double largest = 0;
  for (std::size_t i = 3; i + 3 < a.ranges.size(); ++i) {
    if (std::isfinite(a.ranges[i]))
      largest = std::max(largest, std::abs(static_cast<double>(a.ranges[i]) - b.ranges[i]));
  }
  return largest;
}

TEST(Deskew, GivesTheViewFromTheEndOfTheSweep) {
  const RayCaster walls(room());
  LaserModel laser = lms200();
  laser.scan_duration = 0.1;
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    const Pose2 T_world_robot{random.uniform(-1, 3), random.uniform(-1, 2), random.uniform(-3, 3)};
    const Pose2 T_robot_laser{0.2, 0, 0.1};
    const Vector3d twist(random.uniform(-1, 1), 0, random.uniform(-1.5, 1.5));
    const Scan skewed = sweep(walls, laser, T_world_robot, T_robot_laser, twist);
    const Scan truth = look(walls, laser, T_world_robot, T_robot_laser);
    // Across a corner a chord is cut; elsewhere walls are straight and the correction exact.
    EXPECT_LT(largest_error(deskew(skewed, laser, twist), truth), 0.1);
    std::size_t exact = 0;
    const Scan corrected = deskew(skewed, laser, twist);
    for (std::size_t k = 0; k < truth.ranges.size(); ++k) {
      if (std::abs(corrected.ranges[k] - truth.ranges[k]) < 1e-3) ++exact;
    }
    EXPECT_GT(exact, 150U);
  }
}

TEST(Deskew, ChangesNothingWithoutASweepOrAMotion) {
  const RayCaster walls(room());
  LaserModel laser = lms200();
  const Scan scan = look(walls, laser, {0.5, 0.5, 0.3});
  EXPECT_EQ(deskew(scan, laser, {1, 0, 1}).ranges, scan.ranges);
  laser.scan_duration = 0.1;
  EXPECT_EQ(deskew(scan, laser, Vector3d::Zero()).ranges, scan.ranges);
}

TEST(Deskew, LeavesBeamsWithoutAReturnAlone) {
  LaserModel laser = lms200();
  laser.scan_duration = 0.1;
  Scan scan;
  scan.ranges.assign(181, 81.83F);
  scan.ranges[7] = -1;
  const Scan corrected = deskew(scan, laser, {1, 0, 1});
  EXPECT_EQ(corrected.ranges, scan.ranges);
}

TEST(Deskew, MakesNoSurfaceWhereThereIsNone) {
  // Two walls one behind the other: no beam may end between them.
  const RayCaster walls(std::vector<Segment>{{{2, -3}, {2, 0}}, {{8, -20}, {8, 20}}});
  LaserModel laser = lms200();
  laser.scan_duration = 0.1;
  const Vector3d twist(0.5, 0, 1);
  const Scan corrected = deskew(sweep(walls, laser, {}, {}, twist), laser, twist);
  for (int beam = 0; beam < laser.beams; ++beam) {
    const double range = corrected.ranges[beam];
    if (!is_return(corrected.ranges[beam], laser)) continue;
    const double x = range * std::cos(laser.bearing(beam));
    EXPECT_FALSE(x > 2.3 && x < 7.7) << "beam " << beam << " x " << x;
  }
}

TEST(Deskew, SurvivesAnyTwist) {
  const RayCaster walls(room());
  LaserModel laser = lms200();
  laser.scan_duration = 10;
  const Scan scan = look(walls, laser, {});
  for (const Vector3d& twist : {Vector3d(100, -100, 50), Vector3d(1e300, 0, 1e300), Vector3d(0, 0, 1e-300)}) {
    EXPECT_EQ(deskew(scan, laser, twist).ranges.size(), scan.ranges.size());
  }
}

}  // namespace
}  // namespace helicoid
