// Numbers, trajectories and relations as text.
#include <gmock/gmock.h>

#include <cmath>

#include "helicoid/base/random.hpp"
#include "helicoid/io/number.hpp"
#include "helicoid/io/relations_file.hpp"
#include "helicoid/io/trajectory.hpp"

namespace helicoid {
namespace {

ReadNumber number_of(const std::string& text) {
  TextCursor cursor{text.data(), text.data() + text.size()};
  return read_number(cursor);
}

TEST(Number, IsReadAsTheStandardLibraryReadsIt) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double magnitude = std::pow(10, random.uniform(-8, 12));
    const std::string text = fmt::format("{:.{}f}", random.uniform(-1, 1) * magnitude, random.below(9));
    const ReadNumber number = number_of(text);
    ASSERT_TRUE(number.ok) << text;
    ASSERT_EQ(number.value, std::strtod(text.c_str(), nullptr)) << text;
  }
}

TEST(Number, MayHaveAnExponentBeTinyHugeOrNone) {
  EXPECT_EQ(number_of("1e3").value, 1000);
  EXPECT_EQ(number_of("+2.5").value, 2.5);
  EXPECT_EQ(number_of(".5").value, 0.5);
  EXPECT_EQ(number_of("5.").value, 5);
  EXPECT_EQ(number_of("12345678901234567890123").value, 12345678901234567890123.0);
  EXPECT_TRUE(std::isnan(number_of("nan").value));
  EXPECT_TRUE(std::isinf(number_of("inf").value));
  EXPECT_TRUE(std::signbit(number_of("-0").value));
  for (const char* text : {"", " ", "x", "1x", "--1", "1.2.3", "1e", "-", ".", "0x10"})
    EXPECT_FALSE(number_of(text).ok) << text;
}

TEST(Tum, PosesSurviveToTheMicrometreAndMicrosecond) {
  Random random(2);
  std::vector<StampedPose> poses;
  for (int i = 0; i < 500; ++i) {
    poses.push_back({random.uniform(0, 2e9),
                     {random.uniform(-500, 500), random.uniform(-500, 500), random.uniform(-3.14159, 3.14159)}});
  }
  poses.push_back({-1.5, {-0.0000001, 0, -3.14159265}});
  const TumFile file = parse_tum(to_tum(poses), "x.tum");
  ASSERT_EQ(file.poses.size(), poses.size());
  EXPECT_TRUE(file.skipped.empty());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(file.poses[i].stamp, poses[i].stamp, 0.75e-6);
    EXPECT_NEAR(file.poses[i].pose.x, poses[i].pose.x, 0.6e-6);
    EXPECT_NEAR(file.poses[i].pose.y, poses[i].pose.y, 0.6e-6);
    EXPECT_NEAR(wrap_angle(file.poses[i].pose.yaw - poses[i].pose.yaw), 0, 3e-6);
  }
}

TEST(Tum, LinesAreExactlyAsTheContractHasThem) {
  EXPECT_EQ(to_tum(std::vector<StampedPose>{{1000.25, {1.5, -2, 0}}}),
            "1000.250000 1.500000 -2.000000 0 0 0 0.000000 1.000000\n");
}

TEST(Tum, LinesThatAreNoPoseAreCounted) {
  const TumFile file = parse_tum("# t x y\n1 2 3\n\n1 2 3 0 0 0 0 0\nnan 0 0 0 0 0 0 1\n5 1 2 0 0 0 0 1\n", "x.tum");
  EXPECT_EQ(file.poses.size(), 1U);
  ASSERT_EQ(file.skipped.size(), 1U);
  EXPECT_EQ(file.skipped[0].count, 3U);
  EXPECT_EQ(file.skipped[0].first, "x.tum:2");
}

TEST(Relations, OfOneRobotAndOfATeamAreToldByTheirColumns) {
  const RelationsFile file = parse_relations("# c\n10 11 1 2 0 0 0 0.5\nrobot1 10 robot2 12 3 4 -0.5\n1 2 3\n", "x");
  ASSERT_EQ(file.relations.size(), 2U);
  EXPECT_EQ(file.relations[0].robot_a, "");
  EXPECT_EQ(file.relations[0].stamp_b, 11);
  EXPECT_EQ(file.relations[0].T_a_b, (Pose2{1, 2, 0.5}));
  EXPECT_EQ(file.relations[1].robot_b, "robot2");
  EXPECT_EQ(file.relations[1].T_a_b, (Pose2{3, 4, -0.5}));
  ASSERT_EQ(file.skipped.size(), 1U);
  EXPECT_EQ(file.skipped[0].first, "x:4");
}

}  // namespace
}  // namespace helicoid
