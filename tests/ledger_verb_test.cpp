// An operator's word on a map: listed, given, explained, taken back.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace helicoid::program {

namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

std::string hash_of(const std::string& folder) {
  return Json::parse(run({"info", folder + "/map.gpkg", "--json"}).out)["content_hash"];
}

Json entries_of(const std::string& folder) {
  return Json::parse(run({"ledger", folder, "--json"}).out)["entries"];
}

/// A loop corridor that is driven twice, mapped with its closures into `site`.
class ALoopThatWasClosed : public testing::Test {
 protected:
  ALoopThatWasClosed() {
    EXPECT_EQ(run({"simulate", "loop", "--laps", "2", "--out", box_ / "sim"}).exit_code, 0);
    EXPECT_EQ(run({"map", log_, "--no-charts", "--out", site_}).exit_code, 0);
    const Json entries = entries_of(site_);
    for (const Json& entry : entries) {
      if (accepted_.empty() && entry["state"] == "accepted") accepted_ = entry["id"].dump();
    }
  }
  Sandbox box_;
  std::string log_ = box_ / "sim/robot1.clf.gz";
  std::string site_ = box_ / "site";
  std::string accepted_;  ///< an accepted entry's id
};

void expect_refused(const std::vector<std::string>& command, const std::string& said) {
  const Ended ended = run(command);
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err, HasSubstr(said));
}

}  // namespace

TEST_F(ALoopThatWasClosed, OpensWhenItIsRejectedAndIsToTheBitAsBeforeWhenThatIsUndone) {
  ASSERT_FALSE(accepted_.empty());
  ASSERT_EQ(run({"ledger", site_, "reject", accepted_, "--out", box_ / "rejected"}).exit_code, 0);
  EXPECT_NE(hash_of(box_ / "rejected"), hash_of(site_));
  EXPECT_EQ(entries_of(box_ / "rejected").at(std::stoul(accepted_))["state"], "rejected");
  EXPECT_EQ(entries_of(box_ / "rejected").at(std::stoul(accepted_))["decided_by"], "operator");
  ASSERT_EQ(run({"ledger", box_ / "rejected", "undo", accepted_, "--out", box_ / "undone"}).exit_code, 0);
  EXPECT_EQ(hash_of(box_ / "undone"), hash_of(site_));
  EXPECT_EQ(bytes_of(box_ / "undone/ledger.json"), bytes_of(site_ + "/ledger.json"));
}

TEST_F(ALoopThatWasClosed, IsTheSameWhetherAWordIsGivenAfterwardsOrFromTheStart) {
  ASSERT_EQ(run({"ledger", site_, "undo", accepted_, "--out", box_ / "after"}).exit_code, 0);
  ASSERT_EQ(run({"map", log_, "--decisions", box_ / "after/decisions.json", "--no-charts", "--out", box_ / "start"})
                .exit_code,
            0);
  EXPECT_EQ(hash_of(box_ / "after"), hash_of(box_ / "start"));
  EXPECT_EQ(bytes_of(box_ / "after/ledger.json"), bytes_of(box_ / "start/ledger.json"));
}

TEST_F(ALoopThatWasClosed, IsExplainedInSentences) {
  const Ended entry = run({"explain", site_, accepted_});
  EXPECT_EQ(entry.exit_code, 0);
  EXPECT_THAT(entry.out, HasSubstr("Entry " + accepted_ + " says that robot1 at"));
  EXPECT_THAT(entry.out, HasSubstr("It is accepted, by the evidence"));
  EXPECT_THAT(entry.out, HasSubstr("relations tie the one passage to the other"));
  const Ended places = run({"explain", site_, "robot1@" + entries_of(site_).at(0)["b"]["stamp"].dump(), "0,0"});
  EXPECT_EQ(places.exit_code, 0);
  EXPECT_THAT(places.out, HasSubstr("0,0 lies"));
  EXPECT_THAT(places.out, HasSubstr("By the robot's way alone"));
}

TEST_F(ALoopThatWasClosed, SaysWhatIsWrongWithAWordThatCannotBeFollowed) {
  expect_refused({"ledger", site_, "accept", accepted_, "--out", box_ / "out"}, "is accepted already");
  expect_refused({"ledger", site_, "reject", "100000", "--out", box_ / "out"}, "there is no entry 100000");
  expect_refused({"ledger", box_ / "sim", "reject", "0", "--out", box_ / "out"}, "ledger.json");
  expect_refused({"explain", site_, "100000"}, "there is no entry 100000");
  expect_refused({"explain", site_, "robot7@1", "0,0"}, "no robot robot7; it has robot1");
  expect_refused({"explain", site_, "robot1@1e9", "0,0"}, "no scan within 10 s");
  expect_refused({"explain", site_, "here"}, "name an entry of the ledger");
  EXPECT_EQ(run({"ledger", site_, "reject", accepted_}).exit_code, 2);
  std::filesystem::remove(log_);
  expect_refused({"ledger", site_, "reject", accepted_, "--out", box_ / "out"}, "the log is not there");
}

TEST_F(ALoopThatWasClosed, RefusesDecisionsThatMakeNoSense) {
  const auto refuses = [&](const std::string& text, const std::string& said) {
    expect_refused({"map", log_, "--no-charts", "--decisions", box_.write("d.json", text), "--out", box_ / "out"},
                   said);
  };
  refuses("", "is no file of decisions");
  refuses("{\"decisions\": 3}", "is no file of decisions");
  refuses("[1, 2", "is no file of decisions");
  refuses("{\"decisions\": [7]}", "decision 1 is no object");
  refuses("{\"decisions\": [{\"state\": \"maybe\"}]}", "decision 1 needs a \"state\"");
  refuses("{\"decisions\": [{\"state\": \"open\", \"source\": \"lookalike\", \"a\": {\"robot\": 3}}]}",
          "needs \"a\" and \"b\"");
  const std::string nowhere =
      box_.write("e.json",
                 "{\"decisions\": [{\"state\": \"open\", \"source\": \"lookalike\", \"a\": {\"robot\": "
                 "\"x\", \"stamp\": 1}, \"b\": {\"robot\": \"y\", \"stamp\": 2}}]}");
  const Ended unused = run({"map", log_, "--no-charts", "--decisions", nowhere, "--out", box_ / "out"});
  EXPECT_EQ(unused.exit_code, 3);
  EXPECT_THAT(unused.err, HasSubstr("1 x decision that met no entry"));
}

}  // namespace helicoid::program
