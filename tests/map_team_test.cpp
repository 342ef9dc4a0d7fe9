// helicoid map of a folder of robots without lasers.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "helicoid/eval/team_error.hpp"
#include "helicoid/io/graph_reader.hpp"
#include "helicoid/io/trajectory.hpp"
#include "helicoid/simulation/mark_simulator.hpp"
#include "tests/mrclam_folder.hpp"
#include "tests/program.hpp"

namespace helicoid::program {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Json = nlohmann::json;

/// A drive of two minutes with wrong barcodes, written as a folder; the truth stays here.
class MapTeam : public testing::Test {
 protected:
  MapTeam() : team_(simulate_marks(drive())), folder_(box_ / "team") {
    fs::create_directories(folder_);
    for (const auto& [name, text] : mrclam::files_of(team_.log)) box_.write("team/" + name, text);
  }
  static MarkSimulation drive() {
    MarkSimulation options;
    options.seed = 11;
    options.robots = 3;
    options.landmarks = 8;
    options.seconds = 120;
    options.wrong = 0.05;
    return options;
  }

  Sandbox box_;
  SimulatedTeam team_;
  std::string folder_;
};

TEST_F(MapTeam, WritesPosesNearTheTruthAndWhatElseItPromises) {
  const Ended ended = run({"map", folder_, "--out", box_ / "site", "--json"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(files_in(box_ / "site"), ElementsAre("graph.g2o", "map.svg", "summary.json", "trajectories/robot1.tum",
                                                   "trajectories/robot2.tum", "trajectories/robot3.tum"));
  std::vector<TeamTrack> tracks;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto file = read_tum((box_ / "site") + "/trajectories/" + team_.log.robots[i].name + ".tum");
    ASSERT_TRUE(file);
    TeamTrack track{{}, {}, team_.stamps, team_.truth[i]};
    for (const StampedPose& p : file->poses) track.stamps.push_back(p.stamp), track.poses.push_back(p.pose);
    tracks.push_back(std::move(track));
  }
  EXPECT_EQ(tracks[0].poses.front().translation(), Vector2d(0, 0));
  const TeamError error = team_error(tracks);
  EXPECT_GT(error.matched, 3500U);
  EXPECT_LT(error.rms_m, 0.06);
  const Json summary = Json::parse(ended.out);
  EXPECT_EQ(summary["island_count"], 1);
  EXPECT_EQ(summary["status"], "converged");
  EXPECT_NEAR(summary["wrong_detections"].get<double>(), static_cast<double>(team_.wrong),
              0.1 * static_cast<double>(team_.wrong));
  EXPECT_EQ(summary["landmarks"].size(), 8U);
}

TEST_F(MapTeam, TheGraphFileHoldsTheFactorsAndTheirOptimum) {
  const Ended ended = run({"map", folder_, "--out", box_ / "site", "--no-charts", "--json"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const double cost = Json::parse(ended.out)["final_cost"];
  const Ended fitted = run({"fit", (box_ / "site") + "/graph.g2o", "--json"});
  ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
  const Json fit = Json::parse(fitted.out);
  EXPECT_EQ(fit["components"], 1);
  EXPECT_NEAR(fit["initial_cost"].get<double>(), cost, 1e-4 * cost);
  EXPECT_NEAR(fit["final_cost"].get<double>(), cost, 1e-4 * cost);
}

TEST_F(MapTeam, OptionsThatNeedScansAreRefusedByName) {
  const Ended ended = run({"map", folder_, "--out", box_ / "site", "--every", "2", "--no-closures"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err, HasSubstr("holds no laser scans; leave out --every, --no-closures"));
  EXPECT_FALSE(fs::exists(box_ / "site"));
  const Ended two = run({"map", folder_, box_.write("other.log", "x"), "--out", box_ / "site"});
  EXPECT_EQ(two.exit_code, 1);
  EXPECT_THAT(two.err, HasSubstr("name it alone"));
}

TEST_F(MapTeam, ADamagedFolderLeavesTheOldResults) {
  ASSERT_EQ(run({"map", folder_, "--out", box_ / "site"}).exit_code, 0);
  const std::string before = bytes_of(box_ / "site/trajectories/robot2.tum");
  fs::remove(folder_ + "/Robot2_Measurement.dat");
  const Ended ended = run({"map", folder_, "--out", box_ / "site"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err, HasSubstr("Robot2_Measurement.dat"));
  EXPECT_EQ(bytes_of(box_ / "site/trajectories/robot2.tum"), before);
}

TEST_F(MapTeam, WhatIsLeftOutIsSaid) {
  box_.write("team/Robot1_Measurement.dat", bytes_of(folder_ + "/Robot1_Measurement.dat") + "1 2 3\n9999 1234 1 0\n");
  const Ended ended = run({"map", folder_, "--out", box_ / "site"});
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_THAT(ended.err, HasSubstr("1 x line without the numbers that its file has, first at"));
  EXPECT_THAT(ended.err, HasSubstr("Barcodes.dat does not name"));
  EXPECT_THAT(ended.out, HasSubstr("no scans"));
}

}  // namespace
}  // namespace helicoid::program
