// helicoid plot and its charts.
#include <gmock/gmock.h>

#include "apps/chart.hpp"
#include "tests/program.hpp"

namespace helicoid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Chart, TicksAreRoundNumbersInsideTheRange) {
  EXPECT_THAT(round_ticks(0, 10, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(round_ticks(-0.013, 0.031, 4), ElementsAre(-0.01, 0, 0.01, 0.02, 0.03));
  EXPECT_THAT(round_ticks(1997, 2003, 3), ElementsAre(1998, 2000, 2002));
}

TEST(Chart, OfNothingAndOfOnePointIsStillAChart) {
  for (const std::vector<Vector2d>& points : {std::vector<Vector2d>{}, std::vector<Vector2d>{{3, 4}}}) {
    const std::string svg = draw_charts({{"title", "x", "y", {{"a", points, 0, Series::Look::line}}, {}, false, {}}});
    EXPECT_THAT(svg, HasSubstr("title"));
    EXPECT_THAT(svg, testing::Not(HasSubstr("nan")));
    EXPECT_THAT(svg, testing::Not(HasSubstr("inf\"")));
  }
}

TEST(Chart, WordsAreEscaped) {
  EXPECT_THAT(draw_charts({{"a < b & c", "", "", {}, {}, false, {}}}), HasSubstr("a &lt; b &amp; c"));
}

TEST(PlotVerb, DrawsAMapsFolder) {
  const program::Sandbox box;
  const std::string sim = box.simulate("sim");
  ASSERT_EQ(program::run({"map", sim + "/robot1.clf.gz", "--no-charts", "--out", box / "site"}).exit_code, 0);
  ASSERT_EQ(program::run({"plot", box / "site", "--truth", sim + "/truth"}).exit_code, 0);
  EXPECT_THAT(program::files_in(box / "site/plots"), ElementsAre("residuals.svg", "time.svg", "trajectory.svg"));
  EXPECT_THAT(program::bytes_of(box / "site/plots/trajectory.svg"), HasSubstr("truth"));
}

TEST(PlotVerb, SaysWhatAFolderLacks) {
  const program::Sandbox box;
  const program::Ended ended = program::run({"plot", box / "nothing"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err, HasSubstr("summary.json"));
}

TEST(BenchVerb, PrintsOursBesideTheBaseline) {
  const program::Ended ended = program::run({"bench", "--filter", "rays", "--repeats", "1"});
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_THAT(ended.out, testing::AllOf(HasSubstr("RayCaster"), HasSubstr("every wall")));
  EXPECT_EQ(program::run({"bench", "--filter", "alchemy"}).exit_code, 1);
}

}  // namespace
}  // namespace helicoid
