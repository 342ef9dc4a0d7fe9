#include "helicoid/io/carmen_reader.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "helicoid/io/carmen_writer.hpp"

namespace helicoid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CarmenReader reader_of(const std::string& text) {
  return CarmenReader({{"robot2.log", text, {}}}, make_id<RobotId>(3));
}

std::vector<Event> events_of(CarmenReader& reader) {
  std::vector<Event> events;
  while (const Event* event = reader.next()) events.push_back(*event);
  return events;
}
std::vector<Event> events_of(const std::string& text) {
  CarmenReader reader = reader_of(text);
  return events_of(reader);
}
const Scan& scan_of(const Event& event) {
  return std::get<Scan>(event.body);
}

std::size_t skipped(const CarmenReader& reader) {
  std::size_t count = 0;
  for (const Skipped& s : reader.skipped()) count += s.count;
  return count;
}

const std::string kFrontLaser = "FLASER 4 1.00 2.50 81.83 0.07 9.9 8.0 0.5 10.0 8.0 0.5 1000.25 nomad 7.5\n";
const std::string kRobotLaser =
    "ROBOTLASER1 4 -1.5 3.0 0.75 81.9 0.01 0 4 1 2 3 4 2 0.1 0.2 9.9 8.0 0.5 10.0 8.0 0.5 0.3 0.1 0.4 0.4 0 1000.25 "
    "host 7\n";
const std::string kRawLaser = "RAWLASER1 0 -1.5 3.0 0.75 81.9 0.01 0 4 1 2 3 4 0 1000.25 host 7\n";
const std::string kOdometry = "ODOM 1.5 -2.5 0.25 0.4 0.1 0 999.5 host 6\n";

TEST(CarmenReader, ReadsAFrontLaser) {
  const std::vector<Event> events = events_of(kFrontLaser);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].robot, make_id<RobotId>(3));
  EXPECT_EQ(events[0].stamp, 1000.25);  // the ipc time, not the logger's
  const Scan& scan = scan_of(events[0]);
  EXPECT_THAT(scan.ranges, ElementsAre(1.0F, 2.5F, 81.83F, 0.07F));
  EXPECT_EQ(scan.T_odom_robot, (Pose2{10, 8, 0.5}));
  EXPECT_TRUE(scan.has_odometry);
  // The first pose is the laser's.
  const Pose2 T_robot_laser = Pose2{10, 8, 0.5}.inverse() * Pose2{9.9, 8, 0.5};
  EXPECT_NEAR(scan.T_robot_laser.x, T_robot_laser.x, 1e-12);
  EXPECT_NEAR(scan.T_robot_laser.y, T_robot_laser.y, 1e-12);
}

TEST(CarmenReader, TakesStartAndResolutionOfARobotLaserFromItsMessage) {
  CarmenReader reader = reader_of(kRobotLaser);
  const std::vector<Event> events = events_of(reader);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_THAT(scan_of(events[0]).ranges, ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(scan_of(events[0]).T_odom_robot, (Pose2{10, 8, 0.5}));
  ASSERT_EQ(reader.lasers().size(), 1U);
  EXPECT_EQ(reader.lasers()[0].first_bearing, -1.5);
  EXPECT_EQ(reader.lasers()[0].bearing_step, 0.75);
}

TEST(CarmenReader, LasersMayChangeFromScanToScan) {
  std::string other = kRobotLaser;
  other.replace(other.find("-1.5 3.0 0.75"), 13, "-0.5 1.5 0.50");
  CarmenReader reader = reader_of(kRobotLaser + other + kFrontLaser + kRobotLaser);
  const std::vector<Event> events = events_of(reader);
  ASSERT_EQ(events.size(), 4U);
  ASSERT_EQ(reader.lasers().size(), 3U);
  const std::vector<int> lasers{scan_of(events[0]).laser, scan_of(events[1]).laser, scan_of(events[2]).laser,
                                scan_of(events[3]).laser};
  EXPECT_THAT(lasers, ElementsAre(0, 1, 2, 0));
  EXPECT_EQ(reader.lasers()[1].bearing_step, 0.5);
}

TEST(CarmenReader, ARawLaserHasTheOdometryThatWasReportedLast) {
  const std::vector<Event> events = events_of(kRawLaser + kOdometry + kRawLaser);
  ASSERT_EQ(events.size(), 3U);
  EXPECT_FALSE(scan_of(events[0]).has_odometry);
  EXPECT_TRUE(scan_of(events[2]).has_odometry);
  EXPECT_EQ(scan_of(events[2]).T_odom_robot, (Pose2{1.5, -2.5, 0.25}));
}

TEST(CarmenReader, ReadsOdometry) {
  const std::vector<Event> events = events_of(kOdometry);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].stamp, 999.5);
  EXPECT_EQ(std::get<Odometry>(events[0].body).T_odom_robot, (Pose2{1.5, -2.5, 0.25}));
}

TEST(CarmenReader, WhatASightingDidNotMeasureIsEmpty) {
  const std::vector<Event> events =
      events_of("SIGHTING robot2 3.5 nan -0.5 0.1 0.2 0.3 1000 h 1\nSIGHTING ? nan 0.25 nan 0.1 0.2 0.3 1001 h 2\n");
  ASSERT_EQ(events.size(), 2U);
  const auto& known = std::get<Sighting>(events[0].body);
  EXPECT_EQ(known.observed, "robot2");
  EXPECT_EQ(known.range, 3.5);
  EXPECT_FALSE(known.bearing);
  EXPECT_EQ(known.orientation, -0.5);
  EXPECT_EQ(known.sigma_range, 0.1);
  EXPECT_EQ(known.sigma_bearing, 0.2);
  EXPECT_EQ(known.sigma_orientation, 0.3);
  EXPECT_EQ(events[0].stamp, 1000);
  const auto& unknown = std::get<Sighting>(events[1].body);
  EXPECT_EQ(unknown.observed, "?");
  EXPECT_FALSE(unknown.range);
  EXPECT_EQ(unknown.bearing, 0.25);
}

TEST(CarmenReader, ReadsWhatAnotherProgramTakesForTheSamePlace) {
  const std::vector<Event> events = events_of("LOOKALIKE robot1 912.5 0.5 -1.5 0.25 0.1 0.03 1000 camera 1\n");
  ASSERT_EQ(events.size(), 1U);
  const auto& alike = std::get<Lookalike>(events[0].body);
  EXPECT_EQ(alike.robot, "robot1");
  EXPECT_EQ(alike.stamp, 912.5);
  EXPECT_EQ(alike.T_there_robot, (Pose2{0.5, -1.5, 0.25}));
  EXPECT_EQ(alike.sigma_position, 0.1);
  EXPECT_EQ(alike.sigma_heading, 0.03);
  EXPECT_EQ(events[0].stamp, 1000);
}

TEST(CarmenReader, ParametersAndCommentsArePassedOverOthersCounted) {
  CarmenReader reader =
      reader_of("# a comment\nPARAM robot_length 0.5\nSYNC x\n\nTRUEPOS 1 2 3\nTRUEPOS 1 2 3\n" + kOdometry);
  EXPECT_EQ(events_of(reader).size(), 1U);
  ASSERT_EQ(reader.skipped().size(), 1U);
  EXPECT_EQ(reader.skipped()[0].count, 2U);
  EXPECT_EQ(reader.skipped()[0].first, "robot2.log:5: TRUEPOS");
}

TEST(CarmenReader, ALineWithFewerRangesThanBeamsIsSkippedWithItsPlace) {
  CarmenReader reader = reader_of(kFrontLaser + "FLASER 180 1 2 3 0 0 0 0 0 0 1000.5 h 1\n" + kFrontLaser);
  EXPECT_EQ(events_of(reader).size(), 2U);
  ASSERT_EQ(reader.skipped().size(), 1U);
  EXPECT_THAT(reader.skipped()[0].first, HasSubstr("robot2.log:2"));
}

TEST(CarmenReader, BrokenLinesAreCountedOneByOne) {
  for (const char* line :
       {"FLASER x 1", "FLASER 0 0 0 0 0 0 0 1 h 1", "FLASER -3 1", "FLASER 1e12 1", "FLASER nan 1",
        "FLASER 2 1 2 0 0 0 0 0 nan 1 h 1", "FLASER 2 1 2 0 0 0 0 0 0 inf h 1", "ODOM 1 2", "ODOM nan 2 3 0 0 0 1 h 1",
        "SIGHTING robot2 1 2", "SIGHTING", "LOOKALIKE robot1", "LOOKALIKE robot1 1 0 0 0 0 0.1 2 h 1",
        "LOOKALIKE robot1 1 0 nan 0 0.1 0.1 2 h 1", "ROBOTLASER1 0 0 0 0 0 0 0 4 1 2 3 4 0",
        "RAWLASER1 0 0 1 0.5 1 0 0 2 1 2 999999999 1 h 1", "\x01\x02\x03"}) {
    SCOPED_TRACE(line);
    CarmenReader reader = reader_of(std::string(line) + "\n" + kOdometry);
    EXPECT_EQ(events_of(reader).size(), 1U);
    EXPECT_EQ(skipped(reader), 1U);
  }
}

TEST(CarmenReader, OddRangesAreKeptAndCounted) {
  CarmenReader reader = reader_of("FLASER 5 nan inf -inf -2 1 0 0 0 0 0 0 5 h 1\n");
  const std::vector<Event> events = events_of(reader);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_TRUE(std::isnan(scan_of(events[0]).ranges[0]));
  EXPECT_EQ(scan_of(events[0]).ranges[4], 1);
  EXPECT_EQ(skipped(reader), 1U);
}

TEST(CarmenReader, TheOrderOfTheFileRulesWhateverTheStamps) {
  std::string log;
  for (const char* stamp : {"10", "11", "10.1", "10.2", "12"})
    log += std::string("ODOM 0 0 0 0 0 0 ") + stamp + " h 1\n";
  std::vector<double> stamps;
  for (const Event& event : events_of(log)) stamps.push_back(event.stamp);
  EXPECT_THAT(stamps, ElementsAre(10, 11, 10.1, 10.2, 12));
}

TEST(CarmenReader, SeveralFilesAreOneLog) {
  CarmenReader reader({{"a.log", kOdometry + kFrontLaser, {}}, {"b.log", "", {}}, {"c.log", kRawLaser + "BAD x", {}}},
                      {});
  EXPECT_EQ(events_of(reader).size(), 3U);
  EXPECT_EQ(reader.bytes_done() >= reader.bytes(), true);
  EXPECT_EQ(reader.skipped()[0].first, "c.log:2: BAD");
}

TEST(CarmenReader, EndsOfLinesMayBeWindowsOrMissing) {
  EXPECT_EQ(events_of("ODOM 1 2 3 0 0 0 4 h 1\r\nODOM 1 2 3 0 0 0 5 h 1\r\n").size(), 2U);
  EXPECT_EQ(events_of("ODOM 1 2 3 0 0 0 4 h 1").size(), 1U);
}

TEST(CarmenReader, TheJitterOfDecimalsDoesNotMoveTheLaser) {
  const std::vector<Event> events =
      events_of("FLASER 1 1 0.100000 0 0 0 0 0 1 h 1\nFLASER 1 1 0.100001 0.000001 0 0 0 0 2 h 1\n");
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(scan_of(events[0]).T_robot_laser, scan_of(events[1]).T_robot_laser);
}

TEST(CarmenReader, TakesOutTheMotionWithinASweepWhereTheLaserSaysHowLongItLasts) {
  const std::string log =
      "FLASER 5 2.01 2.02 2.05 2.03 2.04 0 0 0 0 0 0 10 h 1\nFLASER 5 2.01 2.02 2.05 2.03 2.04 0 0 0 0.1 0 0.05 10.2 h "
      "1\nFLASER 5 2.01 2.02 2.05 2.03 2.04 0 0 0 "
      "90 0 3 10.4 h 1\n";
  const std::vector<Event> raw = events_of(log);
  CarmenReader reader = reader_of(log);
  std::vector<LaserModel> lasers = reader.lasers();
  lasers[0].scan_duration = 0.1;
  reader.set_lasers(lasers);
  const std::vector<Event> corrected = events_of(reader);
  ASSERT_EQ(corrected.size(), 3U);
  EXPECT_EQ(scan_of(corrected[0]).ranges, scan_of(raw[0]).ranges);  // no speed is known yet
  EXPECT_NE(scan_of(corrected[1]).ranges, scan_of(raw[1]).ranges);
  EXPECT_EQ(scan_of(corrected[2]).ranges, scan_of(raw[2]).ranges);  // 450 m/s is no speed
  EXPECT_EQ(skipped(reader), 2U);
}

TEST(CarmenWriter, WhatItWritesIsReadBack) {
  std::vector<Event> events;
  Scan scan;
  scan.ranges = {1.25F, 81.83F, 0.5F};
  scan.T_odom_robot = {1, 2, 0.5};
  scan.T_robot_laser = {-0.04, 0, 0};
  events.push_back({{}, 1000.123456, scan});
  events.push_back({{}, 1000.2, Odometry{{-1, 3, -2}}});
  events.push_back({{}, 1000.3, Sighting{"robot2", 2.5, {}, 0.25, 0.05, 0.02, 0.1}});
  std::string log;
  for (const Event& event : events) append_carmen(log, event, "host");
  const std::vector<Event> back = events_of(log);
  ASSERT_EQ(back.size(), 3U);
  EXPECT_EQ(scan_of(back[0]).ranges, scan.ranges);
  EXPECT_NEAR(scan_of(back[0]).T_robot_laser.x, -0.04, 2e-6);
  EXPECT_EQ(back[0].stamp, 1000.123456);
  EXPECT_EQ(std::get<Odometry>(back[1].body).T_odom_robot, (Pose2{-1, 3, -2}));
  const auto& sighting = std::get<Sighting>(back[2].body);
  EXPECT_EQ(sighting.range, 2.5);
  EXPECT_FALSE(sighting.bearing);
}

}  // namespace
}  // namespace helicoid
