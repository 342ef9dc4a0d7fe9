// The invariants of the manifold (paper III-A) and the quirks of real logs, on drives through a building that is known.
#include "helicoid/mapping/mapper.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "helicoid/fit/confident_pairs.hpp"
#include "helicoid/geometry/polysolid.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/manifold/neighbours.hpp"
#include "helicoid/manifold/sheets.hpp"
#include "tests/known_building.hpp"

namespace helicoid {
namespace {

using synthetic::building;
using synthetic::Drive;
using synthetic::drive;
using synthetic::lms200;
using synthetic::look;

Mapper map_events(const std::vector<Event>& events) {
  Mapper mapper;
  mapper.add_robot("robot1", {lms200()});
  for (const Event& event : events) mapper.process(event);
  mapper.finish();
  return mapper;
}

/// A map of two laps, made once.
const Map& two_laps() {
  static const Mapper mapper = map_events(drive(2, 1).events);
  return mapper.map();
}

double largest_error(const Map& map, const std::vector<Pose2>& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pose2 T_first_now = truth[0].inverse() * truth[i];
    largest = std::max(largest, (T_first_now.inverse() * map.project(map.robots()[0].trajectory[i].pose)).distance());
  }
  return largest;
}

Polysolid free_space(const Map& map, PatchId id) {
  Ring ring;
  for (const Eigen::Vector2f& p : map.patch(id).free_space) ring.push_back(map.T_plane_patch(id) * p.cast<double>());
  return make_polysolid(ring);
}

TEST(Mapper, GivesEveryScanAPoseNearTheTruth) {
  const Drive d = drive(2, 1);
  EXPECT_EQ(two_laps().robots()[0].trajectory.size(), d.truth.size());
  EXPECT_LT(largest_error(two_laps(), d.truth), 0.10);
}

TEST(Mapper, ALaserThatMeasuresLongDoesNotHoldARobotBackInABareCorridor) {
  // Its walls look bent about the place abreast of the robot, and that bend goes with it.
  const std::vector<Segment> corridor{{{0, 0}, {60, 0}}, {{60, 2}, {0, 2}}};
  Drive d = drive(1, 5, {{10, 1}, {40, 1}}, corridor);
  for (Event& event : d.events) {
    for (float& range : std::get<Scan>(event.body).ranges) range += 0.03F;
  }
  const Mapper mapper = map_events(d.events);
  EXPECT_LT(largest_error(mapper.map(), d.truth), 0.02 * 30);
}

TEST(Manifold, AMatchedRobotStandsOnTheGroundOfItsPatch) {
  Mapper mapper;
  mapper.add_robot("robot1", {lms200()});
  std::size_t matched = 0;
  for (const Event& event : drive(2, 1).events) {
    const Step step = mapper.process(event);
    if (step.status != StepStatus::matched) continue;
    ++matched;
    EXPECT_TRUE(is_ground(mapper.map().patch(step.pose.patch), step.pose.T_patch_robot.translation())) << event.stamp;
  }
  EXPECT_GT(matched, mapper.counts().scans / 2);
}

TEST(Manifold, ExpressingAPoseOnAnotherPatchAndBackChangesNothing) {
  const Map& map = two_laps();
  const Neighbours neighbours = find_neighbours(map);
  for (const TrackedScan& scan : map.robots()[0].trajectory) {
    for (const PatchId other : neighbours[scan.pose.patch.index()]) {
      const ManifoldPose there = map.express(scan.pose, other);
      // Eq. 2: one projection; eq. 3: and back to the same place.
      const Pose2 off = map.project(scan.pose).inverse() * map.project(there);
      ASSERT_LT(off.distance() + std::abs(off.yaw), 1e-12);
      const ManifoldPose back = map.express(there, scan.pose.patch);
      ASSERT_EQ(back.patch, scan.pose.patch);
      ASSERT_NEAR(back.T_patch_robot.x, scan.pose.T_patch_robot.x, 1e-12);
      ASSERT_NEAR(back.T_patch_robot.y, scan.pose.T_patch_robot.y, 1e-12);
      ASSERT_NEAR(wrap_angle(back.T_patch_robot.yaw - scan.pose.T_patch_robot.yaw), 0, 1e-12);
    }
  }
}

TEST(Manifold, NeighboursAreThePatchesThatOverlapAndAreConfidentOfEachOther) {
  const Map& map = two_laps();
  const Neighbours neighbours = find_neighbours(map);
  const NeighbourOptions limits;
  ASSERT_EQ(map.islands().size(), 1U);
  const std::vector<GraphEdge> edges = graph_edges(map, map.islands().front());
  const RelativeCovariance covariance(map.poses(), edges);
  const auto are_confident = [&](std::size_t i, std::size_t j) {
    const ConfidenceInterval interval =
        midway_interval(covariance.of(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)));
    return interval.position < limits.position && interval.heading < limits.heading;
  };
  std::vector<Polysolid> space;
  for (std::size_t i = 0; i < map.patch_count(); ++i) space.push_back(free_space(map, make_id<PatchId>(i)));
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    for (std::size_t j = i + 1; j < map.patch_count(); ++j) {
      const bool found = std::count(neighbours[i].begin(), neighbours[i].end(), make_id<PatchId>(j)) > 0;
      EXPECT_EQ(found, std::count(neighbours[j].begin(), neighbours[j].end(), make_id<PatchId>(i)) > 0);
      if (found) {
        ++pairs;
        EXPECT_TRUE(are_confident(i, j));
        EXPECT_GT(area(intersection(space[i], space[j])), 0);
      } else if (are_confident(i, j)) {
        // The raster has 10 cm cells on every third row: what it may miss is thin.
        EXPECT_EQ(area(offset(intersection(space[i], space[j]), -0.20)), 0);
      }
    }
  }
  EXPECT_GT(pairs, map.patch_count());
}

TEST(Mapper, AddsNothingOnGroundThatItKnows) {
  // Out and back through the hall and into one room.
  const Drive d = drive(4, 2, {{1.2, 5.5}, {3.6, 5.5}, {3.6, 2}, {3.6, 5.5}});
  Mapper mapper;
  mapper.add_robot("robot1", {lms200()});
  const std::size_t lap = (d.events.size() - 1) / 4;
  std::vector<std::size_t> patches;
  for (std::size_t i = 0; i < d.events.size(); ++i) {
    mapper.process(d.events[i]);
    if (i > 0 && i % lap == 0) patches.push_back(mapper.map().patch_count());
  }
  ASSERT_GE(patches.size(), 4U);
  EXPECT_GT(patches[0], 10U);
  // The first lap maps it; the second may still fill in a view; after that hardly anything is new.
  EXPECT_LE(patches[3] - patches[1], patches[1] / 25 + 1);
}

TEST(Mapper, IsTheSameToTheBitTwice) {
  const std::vector<Event> events = drive(1, 3).events;
  const Mapper a = map_events(events);
  const Mapper b = map_events(events);
  ASSERT_EQ(a.map().patch_count(), b.map().patch_count());
  for (std::size_t i = 0; i < a.map().patch_count(); ++i) EXPECT_EQ(a.map().poses()[i], b.map().poses()[i]);
}

// Quirks of real logs.

TEST(Mapper, SurvivesAndCountsImpossibleOdometrySteps) {
  Drive d = drive(1, 4);
  Pose2 jump;
  for (std::size_t i = 0; i < d.events.size(); ++i) {
    // 85 degrees within a scan, once in a hundred, and a jump of 30 m.
    if (i % 100 == 50)
      jump = i == 150 ? Pose2{30, 0, 0} * jump : jump * Pose2{0, 0, radians(i % 200 == 50 ? 179 : -179)};
    auto& scan = std::get<Scan>(d.events[i].body);
    scan.T_odom_robot = jump * scan.T_odom_robot;
  }
  const Mapper mapper = map_events(d.events);
  EXPECT_GE(mapper.counts().odometry_jumps, 3U);
  EXPECT_LT(largest_error(mapper.map(), d.truth), 0.15);
}

TEST(Mapper, MapsWithoutOdometryByConstantVelocityAndSaysSo) {
  Drive d = drive(1, 5);
  for (Event& event : d.events) std::get<Scan>(event.body).has_odometry = false;
  const Mapper mapper = map_events(d.events);
  EXPECT_EQ(mapper.counts().scans_without_odometry, d.events.size());
  EXPECT_LT(largest_error(mapper.map(), d.truth), 0.15);
}

TEST(Mapper, IsNotConfusedByStampsThatStepBack) {
  Drive d = drive(1, 6);
  const Mapper in_order = map_events(d.events);
  for (std::size_t i = 0; i < d.events.size(); ++i) {
    if (i % 20 >= 18) d.events[i].stamp -= 0.9;
  }
  const Mapper stepped = map_events(d.events);
  EXPECT_LT(largest_error(stepped.map(), d.truth), 0.10);
  EXPECT_EQ(stepped.map().robots()[0].trajectory.size(), in_order.map().robots()[0].trajectory.size());
}

TEST(Mapper, PlacesScansWithoutAReturnByOdometry) {
  Drive d = drive(1, 7);
  const double undisturbed = largest_error(map_events(d.events).map(), d.truth);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::size_t blind = 0;
  for (std::size_t i = 40; i < d.events.size(); i += 97) {
    auto& ranges = std::get<Scan>(d.events[i].body).ranges;
    ranges.assign(181, blind++ % 2 == 0 ? 81.83F : nan);
  }
  const Mapper mapper = map_events(d.events);
  EXPECT_EQ(mapper.counts().empty_scans, blind);
  EXPECT_EQ(mapper.map().robots()[0].trajectory.size(), d.events.size());
  EXPECT_LT(largest_error(mapper.map(), d.truth), undisturbed + 0.05);
}

TEST(Mapper, SurvivesOddRangesAndMissingBeams) {
  Drive d = drive(1, 8);
  Random random(8);
  const float odd[] = {std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(),
                       -5,
                       0,
                       81.83F,
                       1e30F};
  for (Event& event : d.events) {
    auto& ranges = std::get<Scan>(event.body).ranges;
    for (float& range : ranges) {
      if (random.chance(0.1)) range = odd[random.below(7)];
    }
    if (random.chance(0.02)) ranges.resize(100);
  }
  const Mapper mapper = map_events(d.events);
  EXPECT_EQ(mapper.map().robots()[0].trajectory.size(), d.events.size());
  EXPECT_LT(largest_error(mapper.map(), d.truth), 0.15);
}

TEST(Mapper, ScansOfTwoLasersMakeOneMap) {
  const RayCaster walls(building());
  LaserModel coarse = lms200();
  coarse.beams = 91;
  coarse.bearing_step *= 2;
  Drive d = drive(1, 9);
  for (std::size_t i = 0; i < d.events.size(); i += 2) {
    auto& scan = std::get<Scan>(d.events[i].body);
    const Pose2 T_odom_robot = scan.T_odom_robot;
    scan = look(walls, coarse, d.truth[i], {-0.3, 0, 0.2});
    scan.T_odom_robot = T_odom_robot;
    scan.laser = 1;
  }
  Mapper mapper;
  mapper.add_robot("robot1", {lms200(), coarse});
  for (const Event& event : d.events) mapper.process(event);
  mapper.finish();
  EXPECT_EQ(mapper.map().robots()[0].trajectory.size(), d.events.size());
  EXPECT_LT(largest_error(mapper.map(), d.truth), 0.15);
}

TEST(Mapper, AnEmptyRunIsAnEmptyMap) {
  Mapper mapper;
  mapper.add_robot("robot1", {lms200()});
  mapper.finish();
  EXPECT_EQ(mapper.map().patch_count(), 0U);
  EXPECT_TRUE(mapper.map().islands().empty());
}

}  // namespace
}  // namespace helicoid
