// docs/formats.md says what the program does, no more and no less.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "helicoid/io/gzip_file.hpp"
#include "helicoid/io/text_file.hpp"
#include "helicoid/simulation/mark_simulator.hpp"
#include "tests/mrclam_folder.hpp"
#include "tests/program.hpp"
#include "tests/source_tree.hpp"

namespace helicoid::program {

namespace {

using source_tree::section_of;
using source_tree::text_of;
using Json = nlohmann::json;
using Words = std::set<std::string>;

std::string formats() {
  return text_of("docs/formats.md");
}

Words matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern, std::regex::ECMAScript | std::regex::multiline);
  Words found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) found.insert((*it)[1]);
  return found;
}

/// What stands in backticks in the first column of a section's tables.
Words first_column(const std::string& section, const std::string& pattern) {
  Words found;
  for (const std::string& cell : matches(section, R"(^\| (`[^|]*) \|)")) found.merge(matches(cell, pattern));
  return found;
}

Words documented_keys(const std::string& title) {
  Words keys = first_column(section_of(formats(), title), "`([^`]+)`");
  EXPECT_FALSE(keys.empty()) << title;
  return keys;
}

/// "robots[].name" for every value of a JSON document.
void add_keys(const Json& json, const std::string& path, Words& keys) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      add_keys(value, path.empty() ? key : fmt::format("{}.{}", path, key), keys);
  } else if (json.is_array()) {
    for (const Json& value : json) add_keys(value, path + "[]", keys);
  } else {
    keys.insert(path);
  }
}

void expect_same(const Words& of_program, const Words& of_page) {
  const auto without = [](const Words& all, const Words& known) {
    Words rest;
    std::set_difference(all.begin(), all.end(), known.begin(), known.end(), std::inserter(rest, rest.end()));
    return rest;
  };
  EXPECT_THAT(without(of_program, of_page), testing::IsEmpty()) << "are not in docs/formats.md";
  EXPECT_THAT(without(of_page, of_program), testing::IsEmpty()) << "are in docs/formats.md alone";
}

Words keys_of(const Json& json) {
  Words keys;
  add_keys(json, "", keys);
  return keys;
}

Json json_of(std::vector<std::string> command) {
  command.emplace_back("--json");
  return Json::parse(run(command).out, nullptr, false);
}

Words verbs() {
  const std::string help = run({"--help"}).out;
  return matches(help.substr(help.find("Subcommands:")), R"(^  ([a-z]+) )");
}

/// A folder of robots without lasers with everything that can be in it: a line that is none, a copy that was cut off.
std::string write_team(const Sandbox& box) {
  MarkSimulation drive;
  drive.robots = 2;
  drive.seconds = 30;
  fs::create_directories(box / "team");
  for (const auto& [name, text] : mrclam::files_of(simulate_marks(drive).log)) {
    box.write("team/" + name, text + (name == "Robot1_Odometry.dat" ? "1 2\n" : ""));
  }
  EXPECT_TRUE(write_gzip_file(box / "team/Robot1_Groundtruth.dat.gz", std::string(5000, ' ')));
  const std::string zipped = bytes_of(box / "team/Robot1_Groundtruth.dat.gz");
  box.write("team/Robot1_Groundtruth.dat.gz", zipped.substr(0, zipped.size() - 8));
  return box / "team";
}

}  // namespace

TEST(Formats, DescribesEveryVerbAndNoOther) {
  expect_same(verbs(), matches(formats(), "^## helicoid ([a-z]+)$"));
}

TEST(Formats, DescribesEveryOptionAndNoOther) {
  for (const std::string& verb : verbs()) {
    Words of_help = matches(run({verb, "--help"}).out, R"(^  (--[a-z-]+))");
    const Words of_page = first_column(section_of(formats(), "helicoid " + verb), "`(--[a-z-]+)");
    SCOPED_TRACE("helicoid " + verb);
    expect_same(of_help, of_page);
  }
}

TEST(Formats, DescribesEveryKeyOfTheSummary) {
  const Sandbox box;
  const std::string log = read_text_file(box.simulate("sim") + "/robot1.clf.gz")->text;
  // Everything that can be in it: something skipped, something to warn of.
  const std::string zipped = bytes_of(box / "sim/robot1.clf.gz");
  const std::string cut = zipped.substr(0, zipped.size() / 2);
  const std::string command = box.write("odd.log", log + "FLASER 3 1\n");
  const Json summary = json_of({"map", command, box.write("cut.log", cut), "--out", box / "site"});
  expect_same(keys_of(summary), documented_keys("summary.json"));
  expect_same(keys_of(Json::parse(bytes_of(box / "site/summary.json"))), documented_keys("summary.json"));
}

TEST(Formats, DescribesEveryKeyOfTheSummaryOfRobotsWithoutLasers) {
  const Sandbox box;
  const Json summary = json_of({"map", write_team(box), "--out", box / "site"});
  expect_same(keys_of(summary), documented_keys("summary.json of robots without lasers"));
}

TEST(Formats, DescribesEveryKeyOfASimulation) {
  const Sandbox box;
  const Json simulation = json_of({"simulate", "room", "--out", box / "sim"});
  expect_same(keys_of(simulation), documented_keys("simulation.json"));
}

TEST(Formats, DescribesEveryKeyOfAnExploration) {
  const Sandbox box;
  const std::string command = box.write("orders", "1 robot1 pause\n");
  const Json summary = json_of({"explore", "room", "--longest", "3", "--orders", command, "--out", box / "site"});
  Words documented = documented_keys("Exploration's summary.json");
  documented.merge(documented_keys("summary.json"));
  Words keys = keys_of(summary);
  // A map's options are others; lists that are empty here.
  std::erase_if(documented, [](const std::string& key) {
    return key == "options.laser" || key == "options.every" || key == "options.from" || key == "options.to" ||
           key == "options.closures" || key == "options.decisions" || key == "options.online";
  });
  for (const std::string& key : documented) {
    if (key.starts_with("frontiers_left[]") || key.starts_with("skipped[]") || key == "inputs[]" || key == "warnings[]")
      keys.insert(key);
  }
  expect_same(keys, documented);
}

TEST(Formats, DescribesEveryKeyOfLies) {
  const Sandbox box;
  const std::string sim = box.simulate("sim", {"--robots", "2"});
  const Json lies = json_of(
      {"corrupt", sim + "/robot1.clf.gz", sim + "/robot2.clf.gz", "--false-sightings", "2", "--out", box / "lies"});
  expect_same(keys_of(lies), documented_keys("lies.json"));
}

TEST(Formats, DescribesEveryKeyOfAnEvaluation) {
  const Sandbox box;
  const std::string sim = box.simulate("sim");
  const std::string truth = sim + "/truth/robot1.tum";
  Words keys = keys_of(json_of({"eval", truth, "--relations", sim + "/truth.relations"}));
  keys.merge(keys_of(json_of({"eval", truth, "--truth", truth})));
  expect_same(keys, documented_keys("eval --json"));
}

TEST(Formats, DescribesEveryKeyOfAFit) {
  const Sandbox box;
  const std::string graph = box.write("graph.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nVERTEX_SE2 0 0 0 nan\n");
  expect_same(keys_of(json_of({"fit", graph})), documented_keys("fit --json"));
}

TEST(Formats, DescribesEveryKeyOfInfo) {
  const Sandbox box;
  const std::string sim = box.simulate("sim");
  ASSERT_EQ(run({"map", sim + "/robot1.clf.gz", "--no-charts", "--out", box / "site"}).exit_code, 0);
  const std::string log = bytes_of(sim + "/robot1.clf.gz");
  const std::string odd = box.write("odd.log", read_text_file(sim + "/robot1.clf.gz")->text + "FLASER 3 1\n");
  Words keys;
  for (const std::string& file : {box / "site/map.gpkg", odd, box.write("cut.log", log.substr(0, log.size() / 2)),
                                  sim + "/truth/robot1.tum", sim + "/truth.relations", write_team(box)}) {
    const Json info = json_of({"info", file});
    EXPECT_TRUE(info.is_object()) << file;
    keys.merge(keys_of(info));
  }
  expect_same(keys, documented_keys("info --json"));
}

TEST(Formats, DescribesEveryKeyOfDecisionsAndExplanations) {
  const Sandbox box;
  const std::string sim = box.simulate("sim", {"--robots", "2"});
  ASSERT_EQ(
      run({"map", sim + "/robot1.clf.gz", sim + "/robot2.clf.gz", "--no-charts", "--out", box / "site"}).exit_code, 0);
  Words keys = keys_of(json_of({"explain", box / "site", "0"}));
  keys.merge(keys_of(json_of({"explain", box / "site", "0,0", "1,1"})));
  // Lists that are empty here.
  for (const char* key : {"supports[]", "conflicts[]", "entries[]"}) keys.insert(key);
  expect_same(keys, documented_keys("explain --json"));
  ASSERT_EQ(run({"ledger", box / "site", "undo", "0", "--no-charts", "--out", box / "undone"}).exit_code, 0);
  expect_same(keys_of(Json::parse(bytes_of(box / "undone/decisions.json"))), documented_keys("decisions.json"));
}

TEST(Formats, DescribesEveryKeyOfABenchmark) {
  Words keys = keys_of(json_of({"bench", "--filter", "rays", "--repeats", "1"}));
  keys.merge(keys_of(json_of({"bench", "--filter", "intel", "--data", "nowhere"})));
  expect_same(keys, documented_keys("bench --json"));
}

TEST(Formats, DescribesEveryKeyOfPlotsAndExperiments) {
  const Sandbox box;
  ASSERT_EQ(run({"map", box.simulate("sim") + "/robot1.clf.gz", "--no-charts", "--out", box / "site"}).exit_code, 0);
  expect_same(keys_of(json_of({"plot", box / "site"})), documented_keys("plot --json"));
  const Ended ended = run({"experiment", "crispness", "--quick", "--data", "nowhere", "--json", "-"});
  Words keys;
  for (const std::string& key : keys_of(Json::parse(ended.out))) {
    keys.insert(std::regex_replace(key, std::regex("metrics\\.[a-z_]+"), "metrics.*"));
  }
  keys.insert("metrics.*.bar.at_least");  // this experiment has none of that kind
  expect_same(keys, documented_keys("experiment --json"));
}

TEST(Formats, DescribesEveryFileOfAMap) {
  const Sandbox box;
  const std::string team = box.simulate("sim", {"--robots", "2"});
  ASSERT_EQ(run({"map", team + "/robot1.clf.gz", team + "/robot2.clf.gz", "--out", box / "site"}).exit_code, 0);
  const Words documented = first_column(section_of(formats(), "helicoid map"), "`([^`-][^`]*)`");
  for (std::string file : files_in(box / "site")) {
    if (file.starts_with("islands/")) continue;
    file = std::regex_replace(file, std::regex("robot[12]"), "ROBOT");
    file = std::regex_replace(file, std::regex("sheets/[0-9]+"), "sheets/N");
    EXPECT_TRUE(documented.contains(file)) << file;
  }
}

TEST(Formats, AMapIsAGeoPackageThatGdalOpens) {
  if (std::system("ogrinfo --version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "ogrinfo is not installed (Debian: gdal-bin), so that map.gpkg was NOT checked as a GeoPackage";
  }
  const Sandbox box;
  ASSERT_EQ(run({"map", box.simulate("sim") + "/robot1.clf.gz", "--out", box / "site"}).exit_code, 0);
  const std::string command = "ogrinfo -al -so -ro '" + (box / "site/map.gpkg") + "' > '" + (box / "said") + "' 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string said = bytes_of(box / "said");
  EXPECT_THAT(said, testing::Not(testing::ContainsRegex("ERROR|Warning")));
  const Words layers = first_column(section_of(formats(), "map.gpkg"), "`([^`]+)`");
  EXPECT_EQ(layers, (Words{"free_space", "patches", "relations", "trajectories"}));
  expect_same(matches(said, "^Layer name: (?!helicoid_)(.*)$"), layers);
  for (const std::string& layer : layers) {
    EXPECT_EQ(matches(said, "Layer name: (" + layer + ")\n(?:.*\n){1,4}Feature Count: [1-9]").size(), 1U) << layer;
  }
}

}  // namespace helicoid::program
