#include "helicoid/sensor/free_space.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "helicoid/geometry/polysolid.hpp"
#include "tests/simulated_view.hpp"

namespace helicoid {
namespace {

using synthetic::all_round;
using synthetic::cluttered_building;
using synthetic::lms200;
using synthetic::look;
using synthetic::visible;

Polysolid solid_of(const std::vector<Eigen::Vector2f>& ring) {
  Ring exact;
  for (const Eigen::Vector2f& p : ring) exact.push_back(p.cast<double>());
  return make_polysolid(exact);
}

Polysolid free_space(const Scan& scan, const LaserModel& laser) {
  return solid_of(free_space_polygon(scan, laser, make_beam_table(laser)));
}

/// A pose from which the laser sees something; the building may hold things anywhere.
Pose2 random_pose(Random& random) {
  return {random.uniform(1, 19), random.uniform(1, 11), random.uniform(-3.14, 3.14)};
}

/// No point of the polygon lies farther behind what hides it than two beams in a row may lie apart; right on a beam
/// none lies behind at all.
void expect_seen(const RayCaster& walls, const Scan& scan, const LaserModel& laser, const Pose2& T_world_robot) {
  const Pose2 T_world_laser = T_world_robot * scan.T_robot_laser;
  const std::vector<float> free = free_ranges(scan, laser);
  for (int beam = 0; beam < laser.beams; ++beam) {
    ASSERT_LE(free[beam], visible(walls, T_world_laser, laser.bearing(beam)) + 1e-4) << "beam " << beam;
  }
  for (const Eigen::Vector2f& vertex : free_space_polygon(scan, laser, make_beam_table(laser))) {
    const Vector2d p_laser = scan.T_robot_laser.inverse() * vertex.cast<double>();
    if (p_laser.norm() < 1e-3) continue;
    ASSERT_LE(p_laser.norm(), visible(walls, T_world_laser, std::atan2(p_laser.y(), p_laser.x())) + laser.largest_gap);
  }
}

/// The share of the area between beams that lies hidden, and how deep at most.
struct Hidden {
  double share = 0, depth = 0;
};
Hidden hidden(const RayCaster& walls, const Scan& scan, const LaserModel& laser, const Pose2& T_world_robot,
              Random& random) {
  const Pose2 T_world_laser = T_world_robot * scan.T_robot_laser;
  const std::vector<float> free = free_ranges(scan, laser);
  Hidden result;
  double all = 0;
  for (int i = 0; i < 4000; ++i) {
    const double at = random.uniform(0, laser.beams - 1);
    const auto beam = static_cast<std::size_t>(at);
    const double r0 = free[beam];
    const double r1 = free[beam + 1];
    if (r0 <= 0 || r1 <= 0) continue;
    const double a = (at - static_cast<double>(beam)) * laser.bearing_step;
    const double b = laser.bearing_step - a;
    const double chord = r0 * r1 * std::sin(laser.bearing_step) / (r0 * std::sin(a) + r1 * std::sin(b));
    const double seen = visible(walls, T_world_laser, laser.first_bearing + at * laser.bearing_step);
    all += chord * chord;
    if (chord > seen) {
      result.share += chord * chord - seen * seen;
      result.depth = std::max(result.depth, chord - seen);
    }
  }
  if (all > 0) result.share /= all;
  return result;
}

TEST(FreeSpace, NeverClaimsWhatTheLaserDidNotSee) {
  Random random(1);
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(i);
    const RayCaster walls(cluttered_building(random));
    const LaserModel laser = i % 2 == 0 ? lms200() : all_round();
    const Pose2 T_world_robot = random_pose(random);
    const Scan scan = look(walls, laser, T_world_robot, {0.1, -0.05, 0.3});
    expect_seen(walls, scan, laser, T_world_robot);
    // Only things that stand between two beams, thinner than their spacing, can hide some of what is claimed.
    EXPECT_LT(hidden(walls, scan, laser, T_world_robot, random).share, 0.02);
  }
}

TEST(FreeSpace, EndsAtTheNearSideOfADiscontinuity) {
  // A wall ends between two beams; the next wall stands 8 m behind it.
  const std::vector<Segment> segments{{{2, -3}, {2, 0.01}}, {{10, -9}, {10, 9}}};
  const RayCaster walls(segments);
  const LaserModel laser = lms200();
  const Scan scan = look(walls, laser, {});
  Random random(2);
  EXPECT_LE(hidden(walls, scan, laser, {}, random).depth, laser.largest_gap + 1e-6);
  EXPECT_FALSE(contains(free_space(scan, laser), Vector2d(6, 0.02)));  // behind the edge, between two beams
  EXPECT_TRUE(contains(free_space(scan, laser), Vector2d(6, 0.5)));
}

TEST(FreeSpace, BeamsThatReturnNothingVouchForNoMoreThanTheirNeighbours) {
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    const RayCaster walls(cluttered_building(random));
    const LaserModel laser = lms200();
    const Pose2 T_world_robot = random_pose(random);
    Scan scan = look(walls, laser, T_world_robot);
    const std::vector<float> whole = free_ranges(scan, laser);
    Scan with_gaps = scan;
    for (float& range : with_gaps.ranges) {
      if (random.chance(0.1)) range = 81.83F;
    }
    const std::vector<float> free = free_ranges(with_gaps, laser);
    for (std::size_t b = 1; b + 1 < free.size(); ++b) {
      if (with_gaps.ranges[b] < 81) {
        // Fewer neighbours may stand in the way: it still ends where it was measured to end.
        ASSERT_LE(free[b], scan.ranges[b] + 1e-6F);
      } else if (with_gaps.ranges[b - 1] < 81 && with_gaps.ranges[b + 1] < 81) {
        ASSERT_LE(free[b], std::min(with_gaps.ranges[b - 1], with_gaps.ranges[b + 1]) + 1e-6F);
      }
    }
    ASSERT_EQ(free.size(), whole.size());
  }
}

TEST(FreeSpace, AScanWithoutAReturnVouchesForNothing) {
  const LaserModel laser = lms200();
  for (const float range : {81.83F, 0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
    Scan scan;
    scan.ranges.assign(181, range);
    EXPECT_TRUE(free_space_polygon(scan, laser, make_beam_table(laser)).empty()) << range;
  }
}

TEST(FreeSpace, OddRangesTakeTheirOwnSectorsOnly) {
  const RayCaster walls(std::vector<Segment>{{{5, -50}, {5, 50}}});
  const LaserModel laser = lms200();
  Scan scan = look(walls, laser, {});
  scan.ranges[90] = std::numeric_limits<float>::quiet_NaN();  // straight ahead
  scan.ranges[100] = -3;
  scan.ranges[110] = 0.01F;  // nearer than the laser measures
  const std::vector<float> free = free_ranges(scan, laser);
  for (const std::size_t beam : {90U, 100U, 110U}) EXPECT_EQ(free[beam], 0);
  const Polysolid space = free_space(scan, laser);
  EXPECT_TRUE(is_valid(space));
  EXPECT_FALSE(contains(space, Vector2d(3, 0)));
  EXPECT_TRUE(contains(space, Vector2d(3, 0.4)));
}

TEST(FreeSpace, EndsWhereBeamsSpreadTooFarApart) {
  const RayCaster walls(std::vector<Segment>{{{40, -100}, {40, 100}}});
  const LaserModel laser = lms200();
  const std::vector<float> free = free_ranges(look(walls, laser, {}), laser);
  for (const float range : free) EXPECT_LE(range * laser.bearing_step, laser.largest_gap + 1e-6);
}

TEST(FreeSpace, OfAWallAtAGrazingAngleStaysOnThisSideOfIt) {
  // Along a corridor: the far beams lie metres apart on the walls.
  const std::vector<Segment> segments{{{-1, 1}, {60, 1}}, {{-1, -1}, {60, -1}}};
  const RayCaster walls(segments);
  const LaserModel laser = lms200();
  const Scan scan = look(walls, laser, {});
  const Polysolid corridor = make_rectangle({-1, -1.001}, {60, 1.001});
  EXPECT_TRUE(contains(corridor, free_space(scan, laser)));
  EXPECT_GT(area(free_space(scan, laser)), 10);
}

TEST(FreeSpace, IsOneAnticlockwiseSimpleRing) {
  Random random(4);
  for (int i = 0; i < 60; ++i) {
    const RayCaster walls(cluttered_building(random));
    const LaserModel laser = i % 2 == 0 ? lms200() : all_round();
    const std::vector<Eigen::Vector2f> ring =
        free_space_polygon(look(walls, laser, random_pose(random)), laser, make_beam_table(laser));
    double twice = 0;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Eigen::Vector2f& p = ring[k];
      const Eigen::Vector2f& q = ring[(k + 1) % ring.size()];
      twice += static_cast<double>(p.x()) * q.y() - static_cast<double>(p.y()) * q.x();
    }
    EXPECT_GT(twice, 0);
    EXPECT_NEAR(area(solid_of(ring)), 0.5 * twice, 1e-6 * twice);
  }
}

TEST(FreeSpace, FewerRangesThanBeamsLeaveTheRestUnseen) {
  const RayCaster walls(std::vector<Segment>{{{5, -50}, {5, 50}}});
  const LaserModel laser = lms200();
  Scan scan = look(walls, laser, {});
  scan.ranges.resize(100);
  const std::vector<float> free = free_ranges(scan, laser);
  EXPECT_EQ(free.size(), 181U);
  EXPECT_GT(free[99], 0);
  EXPECT_EQ(free[100], 0);
}

}  // namespace
}  // namespace helicoid
