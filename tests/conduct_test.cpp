// How the program behaves, whatever it is asked: exit codes, streams, files, Ctrl-C.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "helicoid/io/text_file.hpp"
#include "tests/program.hpp"

namespace helicoid::program {

namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Json = nlohmann::json;

constexpr int kDone = 0;
constexpr int kCouldNot = 1;
constexpr int kUsage = 2;
constexpr int kNotAsAsked = 3;

std::string plain_text(const std::string& log) {
  return read_text_file(log)->text;
}

std::string content_hash(const std::string& map_folder) {
  return Json::parse(run({"info", map_folder + "/map.gpkg", "--json"}).out)["content_hash"];
}

void expect_refused(const Ended& ended, const std::string& said) {
  EXPECT_EQ(ended.exit_code, kCouldNot);
  EXPECT_THAT(ended.out, IsEmpty());
  EXPECT_THAT(ended.err, HasSubstr(said));
}

}  // namespace

TEST(Conduct, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(run({"--version"}).exit_code, kDone);
  EXPECT_THAT(run({"--help"}).out, HasSubstr("Example"));
  EXPECT_THAT(run({"map", "--help"}).out, HasSubstr("Examples"));
}

TEST(Conduct, WrongUsageEndsWith2) {
  EXPECT_EQ(run({}).exit_code, kUsage);
  EXPECT_EQ(run({"mapp"}).exit_code, kUsage);
  EXPECT_EQ(run({"map", "robot1.log"}).exit_code, kUsage);
  EXPECT_EQ(run({"map", "--out", "site"}).exit_code, kUsage);
  EXPECT_EQ(run({"map", "robot1.log", "--out", "site", "--every", "0"}).exit_code, kUsage);
  EXPECT_EQ(run({"map", "robot1.log", "--out", "site", "--fast"}).exit_code, kUsage);
  EXPECT_EQ(run({"eval", "robot1.tum"}).exit_code, kUsage);
}

TEST(Conduct, JsonIsExactlyOneObjectOnStdout) {
  const Sandbox box;
  const std::string sim = box.simulate("sim");
  const std::vector<std::vector<std::string>> commands = {
      {"simulate", "room", "--out", box / "again"},
      {"map", sim + "/robot1.clf.gz", "--out", box / "site"},
      {"info", box / "site/map.gpkg"},
      {"info", sim + "/robot1.clf.gz"},
      {"eval", box / "site", "--relations", sim + "/truth.relations"},
      {"plot", box / "site"},
      {"bench", "--filter", "rays", "--repeats", "1"},
      {"eval", box / "site/trajectories/robot1.tum", "--truth", sim + "/truth/robot1.tum"}};
  for (std::vector<std::string> command : commands) {
    command.emplace_back("--json");
    const Ended ended = run(command);
    EXPECT_EQ(ended.exit_code, kDone) << ended.err;
    EXPECT_TRUE(Json::parse(ended.out, nullptr, false).is_object()) << command.front() << ": " << ended.out;
  }
}

TEST(Conduct, NoProgressBarWhereNobodyWatches) {
  const Sandbox box;
  const Ended ended = run({"map", box.simulate("sim") + "/robot1.clf.gz", "--out", box / "site"});
  EXPECT_THAT(ended.err, Not(HasSubstr("\r")));
}

TEST(Conduct, TrajectoriesWithoutTheirScansEndWith3) {
  const Sandbox box;
  const std::string sim = box.simulate("sim");
  const std::string tum = plain_text(sim + "/truth/robot1.tum");
  const std::string half = box.write("half.tum", tum.substr(0, tum.find('\n', tum.size() / 2) + 1));
  const Ended ended = run({"eval", half, "--relations", sim + "/truth.relations", "--json"});
  EXPECT_EQ(ended.exit_code, kNotAsAsked);
  EXPECT_GT(Json::parse(ended.out)["missing"], 0);
}

TEST(Conduct, AForeignFolderIsRefusedWithoutForce) {
  const Sandbox box;
  const std::string log = box.simulate("sim") + "/robot1.clf.gz";
  fs::create_directories(box / "papers/trajectories");
  box.write("papers/trajectories/letter.txt", "mine");
  expect_refused(run({"map", log, "--out", box / "papers"}), "--force");
  EXPECT_EQ(files_in(box / "papers").size(), 1U);
  EXPECT_EQ(run({"map", log, "--out", box / "papers", "--force"}).exit_code, kDone);
  EXPECT_EQ(run({"map", log, "--out", box / "papers"}).exit_code, kDone) << "its own folder is written anew";
}

TEST(Conduct, ANewRunLeavesNothingOfAnOldOne) {
  const Sandbox box;
  const std::string team = box.simulate("sim", {"--robots", "2"});
  ASSERT_EQ(run({"map", team + "/robot1.clf.gz", team + "/robot2.clf.gz", "--out", box / "site"}).exit_code, kDone);
  ASSERT_TRUE(fs::exists(box / "site/map.png"));
  const std::vector<std::string> fewer = {"map", team + "/robot1.clf.gz", "--no-charts", "--out"};
  for (const char* place : {"site", "fresh"}) {
    std::vector<std::string> command = fewer;
    command.push_back(box / place);
    ASSERT_EQ(run(command).exit_code, kDone);
  }
  EXPECT_EQ(files_in(box / "site"), files_in(box / "fresh"));
}

TEST(Conduct, ARunThatFailsLeavesTheOldMap) {
  const Sandbox box;
  ASSERT_EQ(run({"map", box.simulate("sim") + "/robot1.clf.gz", "--out", box / "site"}).exit_code, kDone);
  const std::vector<std::string> before = files_in(box / "site");
  expect_refused(run({"map", box / "typo.log", "--out", box / "site"}), "typo.log");
  EXPECT_EQ(files_in(box / "site"), before);
  expect_refused(run({"map", box / "typo.log", "--out", box / "new"}), "typo.log");
}

TEST(Conduct, NoReaderSeesHalfAFile) {
  const Sandbox box;
  ASSERT_EQ(run({"map", box.simulate("sim") + "/robot1.clf.gz", "--out", box / "site"}).exit_code, kDone);
  for (const std::string& file : files_in(box / "site")) {
    EXPECT_THAT(file, Not(HasSubstr(".part")));
    EXPECT_GT(fs::file_size(box / ("site/" + file)), 0U) << file;
  }
}

TEST(Conduct, CtrlCWritesWhatThereIs) {
  const Sandbox box;
  const std::string lap = plain_text(box.simulate("sim") + "/robot1.clf.gz");
  std::string laps;
  while (laps.size() < 60'000'000) laps += lap;
  ProgramRun mapping({"map", box.write("robot1.log", laps), "--out", box / "site"});
  while (!fs::exists(box / "site")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  mapping.interrupt();
  const Ended ended = mapping.wait();
  EXPECT_EQ(ended.exit_code, kNotAsAsked) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("interrupted"));
  const Json summary = Json::parse(bytes_of(box / "site/summary.json"));
  const std::size_t lines = static_cast<std::size_t>(std::count(laps.begin(), laps.end(), 'F'));
  EXPECT_GT(summary["scans"], 0);
  EXPECT_LT(summary["scans"], lines);
  EXPECT_EQ(run({"info", box / "site/map.gpkg"}).exit_code, kDone);
  EXPECT_TRUE(fs::exists(box / "site/map.png"));
}

TEST(Conduct, ADashIsStdinAndContentTellsWhatIsZipped) {
  const Sandbox box;
  const std::string zipped = box.simulate("sim") + "/robot1.clf.gz";
  const std::string named_plain = box.write("zipped.log", bytes_of(zipped));
  const std::string named_zipped = box.write("plain.clf.gz", plain_text(zipped));
  int count = 0;
  std::vector<std::string> hashes;
  for (const auto& [log, input] : {std::pair{zipped, ""},
                                   {named_plain, ""},
                                   {named_zipped, ""},
                                   {std::string("-"), zipped.c_str()},
                                   {std::string("-"), named_zipped.c_str()}}) {
    const std::string out = box / ("site" + std::to_string(count++));
    const Ended ended =
        run({"map", "--robot", "r=" + log, "--no-charts", "--out", out}, input[0] ? input : "/dev/null");
    ASSERT_EQ(ended.exit_code, kDone) << ended.err;
    hashes.push_back(content_hash(out));
  }
  EXPECT_THAT(hashes, testing::Each(hashes.front()));
}

TEST(Conduct, TwoRobotsOfOneNameAreAnErrorThatNamesBothLogs) {
  const Sandbox box;
  const std::string a = box.simulate("a") + "/robot1.clf.gz";
  const std::string b = box.simulate("b") + "/robot1.clf.gz";
  const Ended ended = run({"map", a, b, "--out", box / "site"});
  expect_refused(ended, a);
  EXPECT_THAT(ended.err, HasSubstr(b));
  EXPECT_EQ(run({"map", a, "--robot", "other=" + b, "--no-charts", "--out", box / "site"}).exit_code, kDone);
}

TEST(Conduct, APlaceThatCannotBeWrittenIsNamed) {
  const Sandbox box;
  const std::string log = box.simulate("sim") + "/robot1.clf.gz";
  const std::string file = box.write("file", "text");
  expect_refused(run({"map", log, "--out", file}), file);
  expect_refused(run({"map", log, "--out", file + "/site"}), file);
  expect_refused(run({"map", log, "--out", "/proc/helicoid"}), "/proc/helicoid");
}

TEST(Conduct, WhatIsNoLogIsRefusedByName) {
  const Sandbox box;
  expect_refused(run({"map", box / "", "--out", box / "site"}), "directory");
  expect_refused(run({"map", box.write("empty.log", ""), "--out", box / "site"}), "empty.log: is empty");
  expect_refused(run({"map", box.write("binary.log", std::string(500, '\0')), "--out", box / "site"}), "binary");
  expect_refused(run({"map", box.write("letter.log", "Dear Sir,\n"), "--out", box / "site"}), "holds no laser scan");
  expect_refused(run({"map", box.write("nothing.gz", "\x1f\x8b"), "--out", box / "site"}), "nothing.gz");
  expect_refused(run({"info", box / ""}), "directory");
  EXPECT_FALSE(fs::exists(box / "site"));
}

TEST(Conduct, ACutArchiveIsMappedAsFarAsItGoes) {
  const Sandbox box;
  const std::string whole = bytes_of(box.simulate("sim") + "/robot1.clf.gz");
  const Ended ended =
      run({"map", box.write("cut.clf.gz", whole.substr(0, whole.size() / 2)), "--out", box / "site", "--json"});
  EXPECT_EQ(ended.exit_code, kDone) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("cut off"));
  EXPECT_GT(Json::parse(ended.out)["scans"], 10);
}

TEST(Conduct, DamagedLinesAreCountedAndShown) {
  const Sandbox box;
  std::string log = plain_text(box.simulate("sim") + "/robot1.clf.gz");
  std::string ranges;
  for (int beam = 0; beam < 180; ++beam) ranges += beam % 3 == 0 ? " nan" : beam % 3 == 1 ? " -1" : " inf";
  log += "FLASER 180" + ranges + " 0 0 0 0 0 0 1.0 host 1.0\n";                // nothing but odd ranges
  log += "FLASER 180 1.0 2.0 0 0 0 0 0 0 2.0 host 2.0\n";                      // beams are missing
  log += "FLASER 180" + ranges + " 0 nan 0 0 0 inf 3.0 host 3.0\n";            // no pose
  log += "FLASER -4 1 2\nFLASER 99999999999 1\nFLASER\nODOM 1 2\nSIGHTING\n";  // cut or senseless
  const Ended ended = run({"map", box.write("odd.log", log), "--out", box / "site", "--json"});
  EXPECT_EQ(ended.exit_code, kDone) << ended.err;
  const Json summary = Json::parse(ended.out);
  std::size_t counted = 0;
  for (const Json& skipped : summary["skipped"]) counted += skipped["count"].get<std::size_t>();
  EXPECT_GE(counted, 6U) << summary["skipped"].dump(1);
  EXPECT_THAT(ended.err, HasSubstr("odd.log:"));
}

TEST(Conduct, AFullDiscIsNoSuccess) {
  const Sandbox box;
  const std::string log = box.simulate("sim") + "/robot1.clf.gz";
  const std::string command = std::string(HELICOID_PROGRAM) + " info '" + log + "' > /dev/full 2> /dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), kCouldNot);
}

}  // namespace helicoid::program
