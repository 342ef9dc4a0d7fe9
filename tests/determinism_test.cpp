// The same events give the same bytes, whoever runs it and on how many threads.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace helicoid::program {

namespace {

/// Everything that a map's folder holds, without what depends on the clock and the machine.
std::vector<std::pair<std::string, std::string>> contents(const std::string& folder) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string& file : files_in(folder)) {
    std::string bytes = bytes_of(fs::path(folder) / file);
    if (file == "summary.json") {
      auto summary = nlohmann::ordered_json::parse(bytes);
      for (const char* key :
           {"cpu_s", "wall_s", "peak_rss_mb", "scan_us_p50", "scan_us_p99", "scan_us_by_tenth", "phase_cpu_s"}) {
        EXPECT_EQ(summary.erase(key), 1U) << key;
      }
      bytes = summary.dump(1);
    }
    all.emplace_back(file, bytes);
  }
  return all;
}

}  // namespace

TEST(Determinism, TwoRunsOnOneOrTwoThreadsWriteTheSameBytes) {
  const Sandbox box;
  const std::string team = box.simulate("sim", {"--robots", "2", "--people", "2"});
  std::vector<std::vector<std::pair<std::string, std::string>>> results;
  for (const char* threads : {"1", "1", "2"}) {
    const std::string site = box / ("site" + std::to_string(results.size()));
    const Ended ended =
        run({"map", team + "/robot1.clf.gz", team + "/robot2.clf.gz", "--threads", threads, "--out", site});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    results.push_back(contents(site));
    ASSERT_EQ(results.back().size(), results.front().size());
    for (std::size_t i = 0; i < results.front().size(); ++i) {
      EXPECT_EQ(results.back()[i].first, results.front()[i].first);
      EXPECT_EQ(results.back()[i].second == results.front()[i].second, true) << results.front()[i].first << " differs";
    }
  }
  EXPECT_GT(results.front().size(), 10U);
}

TEST(Determinism, TheOrderInWhichLogsAreNamedDoesNotMatter) {
  const Sandbox box;
  const std::string team = box.simulate("sim", {"--robots", "2"});
  const std::string a = team + "/robot1.clf.gz";
  const std::string b = team + "/robot2.clf.gz";
  ASSERT_EQ(run({"map", a, b, "--no-charts", "--out", box / "ab"}).exit_code, 0);
  ASSERT_EQ(run({"map", b, a, "--no-charts", "--out", box / "ba"}).exit_code, 0);
  EXPECT_EQ(contents(box / "ab"), contents(box / "ba"));
}

}  // namespace helicoid::program
