#include "helicoid/io/laser_recognition.hpp"

#include <gmock/gmock.h>

#include "helicoid/base/random.hpp"
#include "helicoid/io/laser_file.hpp"

namespace helicoid {
namespace {

using testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;

std::vector<float> ranges_with(float no_return, int times) {
  Random random(1);
  std::vector<float> ranges;
  for (int i = 0; i < 500; ++i) ranges.push_back(static_cast<float>(random.uniform(0.5, 7.5)));
  ranges.insert(ranges.end(), static_cast<std::size_t>(times), no_return);
  return ranges;
}

TEST(LaserLayout, EvenNumbersOfBeamsStopAStepShort) {
  for (const int beams : {180, 360}) {
    const BeamLayout layout = front_laser_layout(beams);
    EXPECT_DOUBLE_EQ(layout.first_bearing, -0.5 * kPi);
    EXPECT_DOUBLE_EQ(layout.bearing_step, kPi / beams);
  }
}

TEST(LaserLayout, OddNumbersOfBeamsReachFromEndToEnd) {
  for (const int beams : {181, 361}) {
    const BeamLayout layout = front_laser_layout(beams);
    EXPECT_DOUBLE_EQ(layout.first_bearing + (beams - 1) * layout.bearing_step, 0.5 * kPi);
  }
}

TEST(LaserLayout, ASingleBeamHasAStep) {
  EXPECT_GT(front_laser_layout(1).bearing_step, 0);
}

TEST(LaserRecognition, KnowsALaserByTheRangeThatStandsForNoReturn) {
  const BeamLayout layout = front_laser_layout(180);
  for (const float no_return : {81.83F, 81.91F}) {
    const LaserModel laser = recognise_laser(layout, ranges_with(no_return, 50));
    EXPECT_EQ(laser.name, "SICK LMS200");
    EXPECT_LT(laser.max_range, no_return);
    EXPECT_GT(laser.max_range, 80);
    EXPECT_EQ(laser.beams, 180);
  }
  for (const float no_return : {51.1F, 50.0F}) {
    const LaserModel laser = recognise_laser(layout, ranges_with(no_return, 50));
    EXPECT_EQ(laser.name, "SICK LMS200, 50 m");
    EXPECT_LT(laser.max_range, no_return);
    EXPECT_GT(laser.max_range, 49);
  }
}

TEST(LaserRecognition, TheFarthestWallIsNoCode) {
  const LaserModel laser = recognise_laser(front_laser_layout(180), ranges_with(7.9F, 1));
  EXPECT_EQ(laser.name, "unknown laser");
  EXPECT_GT(laser.max_range, 7.9);
}

TEST(LaserRecognition, OddRangesDoNotConfuseIt) {
  std::vector<float> ranges = ranges_with(81.83F, 50);
  ranges.insert(ranges.end(), {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0F});
  EXPECT_EQ(recognise_laser(front_laser_layout(180), ranges).name, "SICK LMS200");
  EXPECT_EQ(recognise_laser(front_laser_layout(180), {}).name, "unknown laser");
}

TEST(LaserFile, LaysItsNumbersOverTheRecognisedLaser) {
  LaserModel recognised;
  recognised.beams = 181;
  const Result<LaserModel> laser =
      parse_laser("# ours\n\nmax_range: 30\nkappa: 4\r\nscan_duration:0.025\n", "ours.txt", recognised);
  ASSERT_TRUE(laser) << laser.error().message;
  EXPECT_EQ(laser->name, "ours.txt");
  EXPECT_EQ(laser->beams, 181);
  EXPECT_EQ(laser->max_range, 30);
  EXPECT_EQ(laser->kappa, 4);
  EXPECT_EQ(laser->scan_duration, 0.025);
  EXPECT_EQ(laser->min_range, recognised.min_range);
}

TEST(LaserFile, SaysTheLineThatIsWrong) {
  const auto message = [](const char* text) {
    const Result<LaserModel> laser = parse_laser(text, "ours.txt", {});
    return laser ? std::string("none") : laser.error().message;
  };
  EXPECT_THAT(message("kappa: 4\ncolour: 3\n"), HasSubstr("ours.txt:2: \"colour: 3\" is no key"));
  for (const char* text : {"kappa: 0", "kappa: -1", "kappa: nan", "kappa: inf", "kappa: x", "kappa: 4 5", "kappa:"}) {
    EXPECT_THAT(message(text), HasSubstr("ours.txt:1: kappa needs a number above 0")) << text;
  }
  EXPECT_THAT(message("min_range: 90\n"), HasSubstr("not below max_range"));
}

TEST(LaserFile, NamesTheShippedLasersWhereThereIsNoFile) {
  const Result<LaserModel> laser = load_laser("no-such-laser", {});
  ASSERT_FALSE(laser);
  EXPECT_THAT(laser.error().message, HasSubstr("sick-lms200"));
  for (const std::string& name : shipped_lasers()) EXPECT_TRUE(load_laser(name, {})) << name;
}

}  // namespace
}  // namespace helicoid
