// Experiments: running, judging, telling.
#include "apps/experiment.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "apps/experiment_page.hpp"
#include "tests/program.hpp"

namespace helicoid {
namespace {

/// Two cases: "low" measures the seed, "high" ten times the seed.
Experiment counting() {
  Experiment e;
  e.name = "counting";
  e.question = "How far?";
  e.method = "By counting.";
  e.seeds = 4;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions& options) {
    const auto times = [](double factor) {
      return [factor](std::uint64_t seed) -> Result<Outcome> {
        return Outcome{{{"way_m", factor * static_cast<double>(seed)}}, {}};
      };
    };
    std::vector<ExperimentCase> cases{{"low", true, "", times(1)}, {"high", true, "", times(10)}};
    cases.push_back({"recorded", false, options.data.empty() ? "no data" : "", times(0)});
    return cases;
  };
  return e;
}

TEST(Experiment, RunsEveryCaseWithEverySeedInOrder) {
  for (const int threads : {1, 2, 7}) {
    const auto report = run_experiment(counting(), {0, false, "somewhere", threads});
    ASSERT_TRUE(report.has_value());
    ASSERT_EQ(report->runs.size(), 9U);
    EXPECT_EQ(report->runs[3].case_name, "low");
    EXPECT_EQ(report->runs[3].outcome.metrics[0].value, 4);
    EXPECT_EQ(report->runs[4].case_name, "high");
    EXPECT_EQ(report->runs[4].outcome.metrics[0].value, 10);
    EXPECT_TRUE(report->skipped.empty());
  }
}

TEST(Experiment, SkippedCasesAreCountedWithTheirReason) {
  const auto report = run_experiment(counting(), {});
  ASSERT_EQ(report->skipped.size(), 1U);
  EXPECT_EQ(report->skipped[0].name, "recorded");
  EXPECT_EQ(report->skipped[0].reason, "no data");
  EXPECT_EQ(report->runs.size(), 8U);
}

TEST(Experiment, QuickAndSeedsDecideHowManySeedsRun) {
  EXPECT_EQ(run_experiment(counting(), {0, true, "", 1})->runs.size(), 2U);
  EXPECT_EQ(run_experiment(counting(), {3, true, "", 1})->runs.size(), 6U);
}

TEST(Experiment, ABarOnEveryRunFailsByOneRun) {
  Experiment e = counting();
  e.bars = {{"way_m", 0.0, 39.0, false}};
  const auto report = run_experiment(e, {});
  EXPECT_FALSE(report->passed);
  EXPECT_TRUE(report->runs[6].passed);
  EXPECT_FALSE(report->runs[7].passed);
  EXPECT_TRUE(report->by_case[0].passed);
  EXPECT_FALSE(report->by_case[1].passed);
  EXPECT_FALSE(report->overall[0].passed);
}

TEST(Experiment, ABarOnTheMeanIsJudgedCaseByCase) {
  Experiment e = counting();
  e.bars = {{"way_m", 2.0, 3.0, true}};
  const auto report = run_experiment(e, {});
  EXPECT_TRUE(report->by_case[0].passed);   // the mean of 1, 2, 3, 4
  EXPECT_FALSE(report->by_case[1].passed);  // the mean of 10, 20, 30, 40
  EXPECT_FALSE(report->passed);
}

TEST(Experiment, AClocksBarIsJudgedInTheWholeFormAlone) {
  Experiment e = counting();
  e.bars = {{"way_m", std::nullopt, 0.5, false, true}};
  EXPECT_FALSE(run_experiment(e, {})->passed);
  EXPECT_TRUE(run_experiment(e, {0, true, "", 1})->passed);
}

TEST(Experiment, NotANumberPassesNoBar) {
  const Bar bar{"way_m", std::nullopt, 1.0, false};
  EXPECT_FALSE(bar.holds(NAN));
  EXPECT_TRUE(bar.holds(1.0));
  EXPECT_FALSE(bar.holds(1.0001));
}

TEST(Experiment, WithoutARunNothingIsPassed) {
  Experiment e = counting();
  e.cases = [](const ExperimentOptions&) { return std::vector<ExperimentCase>{{"recorded", false, "no data", {}}}; };
  EXPECT_FALSE(run_experiment(e, {})->passed);
}

TEST(Experiment, AFailingCaseIsAnErrorThatNamesIt) {
  Experiment e = counting();
  e.cases = [](const ExperimentOptions&) {
    return std::vector<ExperimentCase>{
        {"broken", true, "", [](std::uint64_t) -> Result<Outcome> { return fail("a wheel is off"); }}};
  };
  const auto report = run_experiment(e, {});
  ASSERT_FALSE(report.has_value());
  EXPECT_THAT(report.error().message,
              testing::AllOf(testing::HasSubstr("broken"), testing::HasSubstr("a wheel is off")));
}

TEST(Experiment, JsonHasTheContractsKeys) {
  Experiment e = counting();
  e.bars = {{"way_m", std::nullopt, 39.0, false}};
  const auto json = to_json(e, {}, run_experiment(e, {}).value());
  EXPECT_EQ(json["experiment"], "counting");
  EXPECT_EQ(json["runs"].size(), 8U);
  EXPECT_EQ(json["runs"][7]["seed"], 4);
  EXPECT_EQ(json["runs"][7]["case"], "high");
  EXPECT_EQ(json["runs"][7]["metrics"]["way_m"], 40.0);
  EXPECT_EQ(json["runs"][7]["passed"], false);
  EXPECT_EQ(json["metrics"]["way_m"]["mean"], 13.75);
  EXPECT_EQ(json["metrics"]["way_m"]["min"], 1.0);
  EXPECT_EQ(json["metrics"]["way_m"]["max"], 40.0);
  EXPECT_EQ(json["metrics"]["way_m"]["bar"]["at_most"], 39.0);
  EXPECT_EQ(json["metrics"]["way_m"]["passed"], false);
  EXPECT_EQ(json["passed"], false);
}

TEST(Experiment, ThePageHoldsTheTableAndThePictures) {
  const program::Sandbox box;
  const Experiment e = counting();
  const auto report = run_experiment(e, {});
  ASSERT_TRUE(write_experiment_page(e, {}, *report, box / "docs").has_value());
  const std::string page = program::bytes_of(box / "docs/counting.md");
  EXPECT_THAT(page,
              testing::AllOf(testing::HasSubstr("| high | way_m | 4 | 25 | 10 | 40 |"),
                             testing::HasSubstr("Skipped: recorded (no data)"), testing::HasSubstr("counting.svg")));
  EXPECT_THAT(program::bytes_of(box / "docs/counting.svg"), testing::HasSubstr("<svg"));
}

TEST(ExperimentVerb, ListsWhatThereIs) {
  const program::Ended ended = program::run({"experiment", "list"});
  EXPECT_EQ(ended.exit_code, 0);
  for (const Experiment& e : experiments()) EXPECT_THAT(ended.out, testing::HasSubstr(e.name));
  EXPECT_THAT(ended.out, testing::AllOf(testing::HasSubstr("crispness"), testing::HasSubstr("laps")));
}

TEST(ExperimentVerb, AnUnknownNameIsAMatterOfUsage) {
  const program::Ended ended = program::run({"experiment", "alchemy"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.err, testing::HasSubstr("crispness"));
}

}  // namespace
}  // namespace helicoid
