// helicoid simulate, as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "helicoid/io/relations_file.hpp"
#include "helicoid/io/trajectory.hpp"

namespace helicoid {
namespace {

namespace fs = std::filesystem;

fs::path fresh_folder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / ("simulate_verb_" + name);
  fs::remove_all(folder);
  return folder;
}

int run(const std::string& arguments) {
  const int status = std::system((std::string(HELICOID_PROGRAM) + " " + arguments + " >/dev/null 2>&1").c_str());
  return WEXITSTATUS(status);
}

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(SimulateVerb, WritesTheSameBytesForTheSameSeed) {
  const fs::path a = fresh_folder("a");
  const fs::path b = fresh_folder("b");
  const fs::path c = fresh_folder("c");
  ASSERT_EQ(run("simulate room --robots 2 --people 2 --seed 3 --out " + a.string()), 0);
  ASSERT_EQ(run("simulate room --robots 2 --people 2 --seed 3 --out " + b.string()), 0);
  ASSERT_EQ(run("simulate room --robots 2 --people 2 --seed 4 --out " + c.string()), 0);
  for (const char* name : {"robot1.clf.gz", "robot2.clf.gz", "truth/robot1.tum", "truth/robot2.tum", "truth.relations",
                           "world.yaml", "world.svg", "simulation.json"}) {
    EXPECT_FALSE(bytes_of(a / name).empty()) << name;
    EXPECT_EQ(bytes_of(a / name), bytes_of(b / name)) << name;
  }
  EXPECT_NE(bytes_of(a / "robot1.clf.gz"), bytes_of(c / "robot1.clf.gz"));
}

TEST(SimulateVerb, ItsRelationsAgreeWithItsTruth) {
  for (const int robots : {1, 2}) {
    const fs::path folder = fresh_folder("truth" + std::to_string(robots));
    ASSERT_EQ(run("simulate room --robots " + std::to_string(robots) + " --laps 2 --out " + folder.string()), 0);
    const auto relations = read_relations((folder / "truth.relations").string());
    ASSERT_TRUE(relations.has_value());
    EXPECT_GT(relations->relations.size(), 40U);
    EXPECT_TRUE(relations->skipped.empty());
    for (const TrueRelation& r : relations->relations) {
      const auto pose_at = [&](const std::string& robot, double stamp) {
        const auto truth = read_tum((folder / "truth" / ((robot.empty() ? "robot1" : robot) + ".tum")).string());
        const auto found = std::find_if(truth->poses.begin(), truth->poses.end(),
                                        [&](const StampedPose& p) { return std::abs(p.stamp - stamp) < 5e-6; });
        EXPECT_NE(found, truth->poses.end());
        return found->pose;
      };
      const Pose2 error = r.T_a_b.inverse() * (pose_at(r.robot_a, r.stamp_a).inverse() * pose_at(r.robot_b, r.stamp_b));
      ASSERT_LT(error.distance() + std::abs(error.yaw), 1e-5);
    }
  }
}

TEST(SimulateVerb, RefusesAFolderThatItDidNotMake) {
  const fs::path folder = fresh_folder("foreign");
  fs::create_directories(folder);
  std::ofstream(folder / "letter.txt") << "mine";
  EXPECT_EQ(run("simulate room --out " + folder.string()), 1);
  EXPECT_EQ(run("simulate room --force --out " + folder.string()), 0);
  EXPECT_EQ(bytes_of(folder / "letter.txt"), "mine");
  EXPECT_EQ(run("simulate room --out " + folder.string()), 0);  // its own, now
}

TEST(SimulateVerb, LeavesNoLogOfAnEarlierRun) {
  const fs::path folder = fresh_folder("fewer");
  ASSERT_EQ(run("simulate room --robots 3 --out " + folder.string()), 0);
  ASSERT_EQ(run("simulate room --robots 1 --out " + folder.string()), 0);
  EXPECT_TRUE(fs::exists(folder / "robot1.clf.gz"));
  for (const char* name : {"robot2.clf.gz", "robot3.clf.gz", "truth/robot2.tum"})
    EXPECT_FALSE(fs::exists(folder / name)) << name;
}

TEST(SimulateVerb, DrivesThroughAMapThatWasMade) {
  const fs::path sim = fresh_folder("first");
  const fs::path site = fresh_folder("site");
  const fs::path again = fresh_folder("again");
  ASSERT_EQ(run("simulate room --out " + sim.string()), 0);
  ASSERT_EQ(run("map " + (sim / "robot1.clf.gz").string() + " --out " + site.string()), 0);
  EXPECT_EQ(run("simulate " + (site / "map.yaml").string() + " --out " + again.string()), 0);
  EXPECT_GT(read_tum((again / "truth" / "robot1.tum").string())->poses.size(), 50U);
}

TEST(SimulateVerb, TellsUsageFromFailure) {
  EXPECT_EQ(run("simulate room"), 2);
  EXPECT_EQ(run("simulate room --robots 0 --out " + fresh_folder("none").string()), 2);
  EXPECT_EQ(run("simulate atlantis --out " + fresh_folder("none").string()), 1);
}

}  // namespace
}  // namespace helicoid
