#include "helicoid/io/mrclam_reader.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "helicoid/base/whole_file.hpp"
#include "helicoid/io/gzip_file.hpp"
#include "tests/mrclam_folder.hpp"

namespace helicoid {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class MrclamReader : public testing::Test {
 protected:
  MrclamReader() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("helicoid_mrclam_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~MrclamReader() override { fs::remove_all(folder_); }
  MrclamReader(const MrclamReader&) = delete;
  MrclamReader& operator=(const MrclamReader&) = delete;

  void write(const mrclam::Files& files, bool gzipped = false) const {
    for (const auto& [name, text] : files) {
      const std::string path = (folder_ / name).string();
      ASSERT_TRUE(gzipped ? write_gzip_file(path + ".gz", text) : write_whole_file(path, text));
    }
  }
  [[nodiscard]] std::string folder() const { return folder_.string(); }

  fs::path folder_;
};

TEST_F(MrclamReader, ReadsRobotsLandmarksAndTruthPlainOrGzipped) {
  for (const bool gzipped : {false, true}) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write(mrclam::small_folder(), gzipped);
    ASSERT_TRUE(is_mrclam_folder(folder()));
    const Result<MrclamFolder> read = read_mrclam(folder());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_THAT(read->log.landmarks, ElementsAre("landmark6", "landmark7"));
    ASSERT_EQ(read->log.robots.size(), 3U);
    const TeamRobot& robot = read->log.robots[0];
    EXPECT_EQ(robot.name, "robot1");
    ASSERT_EQ(robot.velocities.size(), 2U);
    EXPECT_EQ(robot.velocities[1].turning, -0.2);
    ASSERT_EQ(robot.detections.size(), 3U);
    EXPECT_EQ(robot.detections[0].subject, 3U);  // landmark6 stands after the three robots
    EXPECT_EQ(robot.detections[0].range, 2.5);
    EXPECT_EQ(robot.detections[2].subject, 1U);  // robot2
    ASSERT_EQ(read->truth[2].size(), 2U);
    EXPECT_NEAR(read->truth[2][0].pose.yaw, 4 - 2 * std::numbers::pi, 1e-12);
    EXPECT_EQ(read->landmarks.at("landmark6"), Vector2d(1.5, -2));
    EXPECT_THAT(read->skipped, IsEmpty());
  }
}

TEST_F(MrclamReader, LinesThatCannotBeUsedAreCountedWithTheirPlace) {
  mrclam::Files files = mrclam::small_folder();
  files["Robot2_Odometry.dat"] += "100.2 0.1\n100.3 0.1 0.1 0.1\n";
  files["Robot2_Measurement.dat"] += "100.1 99 1 0\n100.1 20 1 0\n100.1 60 -1 0\n99 60 1 0\n100.1 61.5 1 0\n";
  write(files);
  const Result<MrclamFolder> read = read_mrclam(folder());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->log.robots[1].velocities.size(), 2U);
  EXPECT_EQ(read->log.robots[1].detections.size(), 2U);
  ASSERT_EQ(read->skipped.size(), 5U);
  std::size_t all = 0;
  for (const Skipped& s : read->skipped) all += s.count;
  EXPECT_EQ(all, 7U);
  EXPECT_EQ(read->skipped[0].count, 2U);
  EXPECT_THAT(read->skipped[0].first, HasSubstr("Robot2_Odometry.dat:4: 3 numbers are expected"));
  EXPECT_THAT(read->skipped[1].reason, HasSubstr("barcode that Barcodes.dat does not name"));
  EXPECT_EQ(read->skipped[1].count, 2U);
  EXPECT_THAT(read->skipped[1].first, HasSubstr("Robot2_Measurement.dat:4"));
}

TEST_F(MrclamReader, ARobotThatHasNoLogIsNoLandmark) {
  mrclam::Files files = mrclam::small_folder();
  files.erase("Robot2_Odometry.dat");
  write(files);
  const Result<MrclamFolder> read = read_mrclam(folder());
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->log.robots.size(), 2U);
  EXPECT_EQ(read->log.robots[1].name, "robot3");
  EXPECT_EQ(read->log.robots[0].detections.size(), 2U);
  ASSERT_EQ(read->skipped.size(), 1U);
  EXPECT_THAT(read->skipped[0].reason, HasSubstr("no log here"));
}

TEST_F(MrclamReader, WhatIsMissingIsNamedWithItsMend) {
  write(mrclam::small_folder());
  fs::remove(folder_ / "Robot3_Measurement.dat");
  const Result<MrclamFolder> read = read_mrclam(folder());
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("Robot3_Measurement.dat: holds no line `time barcode range bearing`"));
  EXPECT_THAT(read.error().message, HasSubstr("put the file of the MRCLAM collection there"));
}

TEST_F(MrclamReader, FoldersOfOtherThingsAreNotTakenForOne) {
  EXPECT_FALSE(is_mrclam_folder(folder()));
  EXPECT_FALSE(is_mrclam_folder(folder() + "/nowhere"));
  ASSERT_TRUE(write_whole_file(folder() + "/Barcodes.dat", "1 10\n"));
  EXPECT_FALSE(is_mrclam_folder(folder()));
  EXPECT_FALSE(read_mrclam(folder()));
}

TEST_F(MrclamReader, TruthMayBeMissing) {
  mrclam::Files files = mrclam::small_folder();
  std::erase_if(files, [](const auto& file) { return file.first.find("Groundtruth") != std::string::npos; });
  write(files);
  const Result<MrclamFolder> read = read_mrclam(folder());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_THAT(read->truth, ElementsAre(IsEmpty(), IsEmpty(), IsEmpty()));
  EXPECT_THAT(read->landmarks, IsEmpty());
}

}  // namespace
}  // namespace helicoid
