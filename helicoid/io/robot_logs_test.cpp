#include "helicoid/io/robot_logs.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace helicoid {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

using Names = std::vector<std::string>;

TEST(RobotNames, AreBaseNamesUpToTheFirstDot) {
  const auto robots = name_robots(Names{"/logs/r2.clf.gz", "monday/r1.log"}, {});
  ASSERT_TRUE(robots);
  EXPECT_EQ((*robots)[0].name, "r1");  // sorted
  EXPECT_EQ((*robots)[1].name, "r2");
  EXPECT_THAT((*robots)[1].paths, ElementsAre("/logs/r2.clf.gz"));
}

TEST(RobotNames, MayBeGivenWithSeveralLogsInTheirOrder) {
  const auto robots = name_robots({}, Names{"r=b.log,a.log"});
  ASSERT_TRUE(robots);
  EXPECT_EQ((*robots)[0].name, "r");
  EXPECT_THAT((*robots)[0].paths, ElementsAre("b.log", "a.log"));
}

TEST(RobotNames, EqualOnesAreAnErrorThatNamesBothFiles) {
  const auto robots = name_robots(Names{"monday/r1.log", "tuesday/r1.log.gz"}, {});
  ASSERT_FALSE(robots);
  EXPECT_THAT(robots.error().message, HasSubstr("monday/r1.log"));
  EXPECT_THAT(robots.error().message, HasSubstr("tuesday/r1.log.gz"));
}

TEST(RobotNames, ThatCannotBeAreRefused) {
  for (const std::string& name :
       {std::string(), std::string("a b"), std::string("a/b"), std::string("ä"), std::string(65, 'a')}) {
    EXPECT_FALSE(name_robots({}, Names{name + "=x.log"})) << name;
  }
  EXPECT_TRUE(name_robots({}, Names{std::string(64, 'a') + "=x.log"}));
  EXPECT_FALSE(name_robots(Names{".hidden"}, {}));
  EXPECT_FALSE(name_robots({}, Names{"r1"}));
  EXPECT_FALSE(name_robots({}, Names{"r1="}));
  EXPECT_FALSE(name_robots({}, Names{"r1=a.log,,b.log"}));
}

class Logs : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return (folder_ / name).string();
  }
  fs::path folder_ = fs::temp_directory_path() / ("helicoid_logs_" + std::to_string(getpid()) +
                                                  testing::UnitTest::GetInstance()->current_test_info()->name());
};

std::string scan_line(double stamp) {
  return fmt::format("FLASER 1 1 0 0 0 0 0 0 {} h 1\n", stamp);
}
std::string odometry_line(double stamp) {
  return fmt::format("ODOM 0 0 0 0 0 0 {} h 1\n", stamp);
}

TEST_F(Logs, AreMergedByTheRunningMaximumOfStampsThenByName) {
  // Robot a's clock steps back after 5: its later events wait for what b did up to then.
  const std::string a = write("a.log", scan_line(1) + odometry_line(5) + odometry_line(2) + odometry_line(6));
  const std::string b = write("b.log", scan_line(1) + odometry_line(3) + odometry_line(5) + odometry_line(5.5));
  auto logs = MergedLogs::open({{"a", {a}}, {"b", {b}}});
  ASSERT_TRUE(logs) << logs.error().message;
  std::vector<std::string> order;
  while (const Event* event = logs->next())
    order.push_back(fmt::format("{}{}", "ab"[event->robot.index()], event -> stamp));
  EXPECT_THAT(order, ElementsAre("a1", "b1", "b3", "a5", "a2", "b5", "b5.5", "a6"));
}

TEST_F(Logs, OfEachRobotKeepTheirOrder) {
  std::string log = scan_line(1);
  const std::vector<double> stamps{4, 3.1, 9, 2, 2, 10};
  for (const double s : stamps) log += odometry_line(s);
  auto logs =
      MergedLogs::open({{"a", {write("a.log", log)}}, {"b", {write("b.log", scan_line(3) + odometry_line(5))}}});
  ASSERT_TRUE(logs);
  std::vector<double> seen;
  while (const Event* event = logs->next()) {
    if (event->robot.index() == 0 && std::holds_alternative<Odometry>(event->body)) seen.push_back(event->stamp);
  }
  EXPECT_EQ(seen, stamps);
}

TEST_F(Logs, ThatCannotBeMappedSayWhy) {
  const auto message = [](const std::string& path) {
    auto logs = MergedLogs::open({{"r", {path}}});
    return logs ? std::string("none") : logs.error().message;
  };
  EXPECT_THAT(message(write("empty.log", "")), HasSubstr("empty"));
  EXPECT_THAT(message(folder_.string()), HasSubstr("is a directory"));
  EXPECT_THAT(message((folder_ / "none.log").string()), HasSubstr("none.log"));
  EXPECT_THAT(message(write("binary.log", std::string("\x7f"
                                                      "ELF\0\0\0",
                                                      7))),
              HasSubstr("binary"));
  EXPECT_THAT(message(write("no_scan.log", odometry_line(1))), HasSubstr("holds no laser scan"));
  EXPECT_THAT(message(write("magic.log", "\x1f\x8b\x08")), HasSubstr("cut off"));
  for (const char* name : {"empty.log", "no_scan.log"})
    EXPECT_THAT(message((folder_ / name).string()), HasSubstr(name));
}

}  // namespace
}  // namespace helicoid
