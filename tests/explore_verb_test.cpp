// helicoid explore, as a user runs it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace helicoid::program {

using Json = nlohmann::json;

namespace {

Json events_of(const std::string& folder) {
  return Json::parse(bytes_of(folder + "/events.json"))["events"];
}

std::size_t count(const Json& events, const std::string& kind) {
  std::size_t found = 0;
  for (const Json& e : events) found += e["kind"] == kind ? 1 : 0;
  return found;
}

}  // namespace

TEST(ExploreVerb, ATeamMapsARoomAndComesHome) {
  const Sandbox box;
  const Ended ended = run({"explore", "room", "--robots", "2", "--json", "--no-charts", "--out", box / "site"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const Json summary = Json::parse(ended.out);
  EXPECT_EQ(summary["end_state"], "explored");
  EXPECT_GE(summary["mapped_fraction"], 0.97);
  EXPECT_THAT(summary["reason"].get<std::string>(),
              testing::ContainsRegex("^[0-9.]+ of [0-9.]+ m2 reachable; no frontier"));
  EXPECT_EQ(summary["collisions"], 0);
  EXPECT_EQ(summary["operator_actions"], 0);
  EXPECT_EQ(summary["island_count"], 1);
  EXPECT_LT(summary["wall_rms_m"], 0.05);
  const Json events = events_of(box / "site");
  EXPECT_EQ(count(events, "joined"), 2U);
  EXPECT_EQ(count(events, "end"), 1U);
}

TEST(ExploreVerb, TheSameSeedWritesTheSameBytes) {
  const Sandbox box;
  for (const char* out : {"a", "b"}) {
    ASSERT_EQ(run({"explore", "room", "--robots", "2", "--longest", "20", "--no-charts", "--out", box / out}).exit_code,
              3);
  }
  for (const char* file :
       {"robot1.clf.gz", "truth/robot2.tum", "events.json", "ledger.json", "trajectories/robot1.tum"}) {
    EXPECT_EQ(bytes_of(box / (std::string("a/") + file)), bytes_of(box / (std::string("b/") + file))) << file;
  }
}

TEST(ExploreVerb, ARobotThatIsPausedStandsStill) {
  const Sandbox box;
  const std::string orders = box.write("orders", "0 all pause\n");
  const Ended ended =
      run({"explore", "room", "--longest", "10", "--orders", orders, "--json", "--no-charts", "--out", box / "site"});
  ASSERT_EQ(ended.exit_code, 3) << ended.err;
  EXPECT_EQ(Json::parse(ended.out)["operator_actions"], 1);
  EXPECT_EQ(Json::parse(ended.out)["patches"], 2);
}

TEST(ExploreVerb, RobotsComeHomeBeforeTheirBatteriesAreEmpty) {
  const Sandbox box;
  const Ended ended =
      run({"explore", "corridor", "--robots", "2", "--charge", "50", "--json", "--no-charts", "--out", box / "site"});
  EXPECT_EQ(ended.exit_code, 3) << "frontiers are left" << ended.err;
  const Json summary = Json::parse(ended.out);
  EXPECT_EQ(summary["end_state"], "stopped");
  const Json events = events_of(box / "site");
  EXPECT_EQ(count(events, "died"), 0U);
  std::size_t recalled = 0;
  for (const Json& e : events) recalled += e["text"] == "home: low battery" ? 1 : 0;
  EXPECT_EQ(recalled, 2U);
  EXPECT_THAT(summary["reason"].get<std::string>(), testing::Not(testing::HasSubstr("not everybody got home")));
}

TEST(ExploreVerb, SaysWhatIsWrongWithStartsAndOrders) {
  const Sandbox box;
  const Ended orders = run({"explore", "room", "--orders", box.write("orders", "soon\n"), "--out", box / "site"});
  EXPECT_EQ(orders.exit_code, 1);
  EXPECT_THAT(orders.err, testing::HasSubstr("orders:1:"));
  const Ended starts = run({"explore", "room", "--starts", box.write("starts", "0 0\n"), "--out", box / "site"});
  EXPECT_EQ(starts.exit_code, 1);
  EXPECT_THAT(starts.err, testing::HasSubstr("starts:1"));
}

}  // namespace helicoid::program
