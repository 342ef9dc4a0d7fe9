#include "helicoid/sensor/scan_points.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/simulated_view.hpp"

namespace helicoid {
namespace {

using synthetic::cluttered_building;
using synthetic::lms200;
using synthetic::look;

TEST(BeamTable, HoldsTheBeamsDirections) {
  const LaserModel laser = lms200();
  const BeamTable table = make_beam_table(laser);
  ASSERT_EQ(table.cosine.size(), 181U);
  for (int beam = 0; beam < laser.beams; ++beam) {
    EXPECT_NEAR(std::atan2(table.sine[beam], table.cosine[beam]), laser.bearing(beam), 1e-6);
  }
  EXPECT_NEAR(laser.field_of_view(), std::numbers::pi, 1e-12);
}

TEST(ScanPoints, LieOnTheWallsInTheRobotsFrame) {
  Random random(1);
  const LaserModel laser = lms200();
  ScanPointExtractor extractor(laser);
  for (int i = 0; i < 50; ++i) {
    const std::vector<Segment> building = cluttered_building(random);
    const RayCaster walls(building);
    const Pose2 T_world_robot{random.uniform(1, 19), random.uniform(1, 11), random.uniform(-3, 3)};
    const ScanPoints& points = extractor.extract(look(walls, laser, T_world_robot, {0.2, 0.1, -0.4}));
    for (std::size_t k = 0; k < points.size(); ++k) {
      ASSERT_LT(walls.clearance(T_world_robot * Vector2d(points.x[k], points.y[k]), 1), 1e-4);
    }
  }
}

TEST(ScanPoints, NormalsAreUnitVectorsThatFaceTheLaserOrAreNone) {
  Random random(2);
  const LaserModel laser = lms200();
  ScanPointExtractor extractor(laser);
  for (int i = 0; i < 50; ++i) {
    const RayCaster walls(cluttered_building(random));
    const Pose2 T_robot_laser{0.2, 0.1, -0.4};
    const ScanPoints& points =
        extractor.extract(look(walls, laser, {random.uniform(1, 19), random.uniform(1, 11), 1}, T_robot_laser));
    for (std::size_t k = 0; k < points.size(); ++k) {
      ASSERT_GE(points.weight[k], 0);
      ASSERT_LE(points.weight[k], 1);
      const float length = std::hypot(points.nx[k], points.ny[k]);
      if (points.weight[k] == 0) {
        ASSERT_EQ(length, 0);
        continue;
      }
      ASSERT_NEAR(length, 1, 1e-5);
      const double towards =
          (T_robot_laser.x - points.x[k]) * points.nx[k] + (T_robot_laser.y - points.y[k]) * points.ny[k];
      ASSERT_GE(towards, 0);
    }
  }
}

TEST(ScanPoints, AStepInAWallHasANormalOfItsOwn) {
  const LaserModel laser = lms200();
  ScanPointExtractor extractor(laser);
  // A corridor along x whose wall steps in by 20 cm: the step alone says how far along a robot is.
  const RayCaster facing(std::vector<Segment>{{{-20, 1.2}, {1, 1.2}}, {{1, 1.2}, {1, 1}}, {{1, 1}, {20, 1}}});
  const Pose2 T_world_robot{0, 0.2, 0.8};
  const ScanPoints& points = extractor.extract(look(facing, laser, T_world_robot));
  std::size_t on_step = 0;
  std::size_t across = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector2d p = T_world_robot * Vector2d(points.x[k], points.y[k]);
    if (std::abs(p.x() - 1) > 1e-3 || p.y() < 1.01 || p.y() > 1.19) continue;
    ++on_step;
    EXPECT_GT(points.weight[k], 0);
    const Vector2d normal = T_world_robot.rotation() * Vector2d(points.nx[k], points.ny[k]);
    across += (normal - Vector2d(-1, 0)).norm() < 0.15 ? 1 : 0;
  }
  EXPECT_GE(on_step, 4U);
  // The one in the corner may as well belong to the wall.
  EXPECT_GE(across + 1, on_step);
}

TEST(ScanPoints, NormalsOfAStraightWallAreItsNormal) {
  Random random(3);
  const LaserModel laser = lms200();
  ScanPointExtractor extractor(laser);
  const RayCaster walls(std::vector<Segment>{{{3, -20}, {3, 20}}});
  for (int i = 0; i < 30; ++i) {
    const Pose2 T_world_robot{random.uniform(0, 2), random.uniform(-1, 1), random.uniform(-0.6, 0.6)};
    const ScanPoints& points = extractor.extract(look(walls, laser, T_world_robot));
    std::size_t trusted = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (points.weight[k] == 0) continue;
      ++trusted;
      const Vector2d n_world = T_world_robot.rotation() * Vector2d(points.nx[k], points.ny[k]);
      ASSERT_LT((n_world - Vector2d(-1, 0)).norm(), 5e-3);
    }
    EXPECT_GT(trusted, 60U);
  }
}

TEST(ScanPoints, ACornersSidesKeepTheirOwnNormals) {
  const LaserModel laser = lms200();
  ScanPointExtractor extractor(laser);
  const RayCaster walls(std::vector<Segment>{{{3, -4}, {3, 3}}, {{3, 3}, {-4, 3}}});
  const ScanPoints& points = extractor.extract(look(walls, laser, {0, 0, 0.8}));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector2d p = Pose2{0, 0, 0.8} * Vector2d(points.x[k], points.y[k]);
    const Vector2d n = Pose2{0, 0, 0.8}.rotation() * Vector2d(points.nx[k], points.ny[k]);
    if (points.weight[k] == 0 || (p - Vector2d(3, 3)).norm() < 0.5) continue;
    ASSERT_LT((n - (p.x() > 2.99 ? Vector2d(-1, 0) : Vector2d(0, -1))).norm(), 0.01);
  }
}

TEST(ScanPoints, AreMadeOfReturnsOnly) {
  const LaserModel laser = lms200();
  ScanPointExtractor extractor(laser);
  Scan scan;
  scan.ranges.assign(181, 81.83F);
  scan.ranges[0] = std::numeric_limits<float>::quiet_NaN();
  scan.ranges[1] = std::numeric_limits<float>::infinity();
  scan.ranges[2] = -2;
  scan.ranges[3] = 0;
  EXPECT_EQ(extractor.extract(scan).size(), 0U);
  scan.ranges[50] = 2;
  scan.ranges[120] = 3;
  const ScanPoints& points = extractor.extract(scan);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points.beam[0], 50);
  EXPECT_EQ(points.beam[1], 120);
  EXPECT_EQ(points.weight[0], 0);  // a single point has no normal
}

TEST(ScanPoints, DoNotDependOnWhatWasExtractedBefore) {
  Random random(4);
  const LaserModel laser = lms200();
  const RayCaster walls(cluttered_building(random));
  const Scan scan = look(walls, laser, {10, 6, 0.5});
  ScanPointExtractor fresh(laser);
  ScanPointExtractor used(laser);
  (void)used.extract(look(walls, laser, {3, 3, -1}));
  Scan empty;
  (void)used.extract(empty);
  const ScanPoints& a = fresh.extract(scan);
  const ScanPoints& b = used.extract(scan);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.nx, b.nx);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.beam, b.beam);
}

TEST(PrefixMoments, OfARunAreTheDifferenceOfItsEnds) {
  PrefixMoments sum;
  for (int i = 0; i < 10; ++i) sum = sum.plus(i, 2 * i);
  EXPECT_EQ(sum.x, 45);
  EXPECT_EQ(sum.y, 90);
  EXPECT_EQ(sum.xx, 285);
  EXPECT_EQ(sum.xy, 570);
  EXPECT_EQ(sum.yy, 1140);
}

}  // namespace
}  // namespace helicoid
