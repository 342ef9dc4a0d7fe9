// The quirks of recorded logs, where they are at hand.
#include <gtest/gtest.h>

#include <filesystem>

#include "apps/map_run.hpp"
#include "apps/team_run.hpp"

namespace helicoid {
namespace {

const std::string kData = std::string(HELICOID_SOURCE_DIR) + "/../shared/data/";

Result<MapRun> map_log(const std::string& name) {
  MapJob job;
  job.robots = {{name, {kData + name + "/" + name + ".clf.gz"}}};
  return run_map(job);
}

std::size_t scans_of(const MapRun& run) {
  return run.mapper.map().robots()[0].trajectory.size();
}

TEST(RecordedLogs, ImpossibleOdometryStepsAreSurvivedAndCounted) {
  if (!std::filesystem::exists(kData + "csail")) GTEST_SKIP() << "no recorded logs in " << kData;
  const Result<MapRun> run = map_log("csail");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(scans_of(*run), 1988U);
  EXPECT_GE(run->mapper.counts().odometry_jumps, 6U);
  EXPECT_LE(run->mapper.counts().odometry_jumps, 9U);
  EXPECT_LT(run->mapper.counts().predicted, 20U);
}

TEST(RecordedLogs, StampsThatStepBackAreNoImpossibleSteps) {
  if (!std::filesystem::exists(kData + "intel")) GTEST_SKIP() << "no recorded logs in " << kData;
  const Result<MapRun> run = map_log("intel");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(scans_of(*run), 13631U);
  EXPECT_EQ(run->mapper.counts().odometry_jumps, 0U);
  EXPECT_LT(run->mapper.counts().predicted, 140U);
}

TEST(RecordedLogs, FiveRobotsWithoutLasersAreFoundFromUnknownStarts) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "15 minutes of five robots take minutes with sanitizers; TeamFit's simulated teams run the same code";
#endif
  if (!is_mrclam_folder(kData + "mrclam6")) GTEST_SKIP() << "no recorded logs in " << kData;
  const Result<MrclamFolder> folder = read_mrclam(kData + "mrclam6");
  ASSERT_TRUE(folder) << folder.error().message;
  ASSERT_EQ(folder->skipped.size(), 1U);
  EXPECT_EQ(folder->skipped[0].count, 6U);  // barcodes that nobody wears
  const TeamFit fit = fit_team(folder->log);
  EXPECT_TRUE(fit.is_still);
  const TeamError error = score_team(*folder, fit);
  EXPECT_GT(error.matched, 40000U);
  EXPECT_LT(error.rms_m, 0.15);
}

}  // namespace
}  // namespace helicoid
