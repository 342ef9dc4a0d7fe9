#include "helicoid/io/graph_reader.hpp"

#include <gmock/gmock.h>

#include "helicoid/fit/fit_from_start.hpp"
#include "helicoid/fit/initial_guess.hpp"

namespace helicoid {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const char* const kEdge = "EDGE_SE2 3 4 1 2 0.5 11 12 13 22 23 33\n";

}  // namespace

TEST(GraphReader, ReadsTheUpperHalfOfTheInformationInG2osOrder) {
  const GraphFile file = parse_graph("EDGE_SE2 3 4 1 2 0.5 11 1 2 22 3 33\n", "t");
  ASSERT_EQ(file.graph.relations.size(), 1U);
  EXPECT_THAT(file.ids, ElementsAre(3, 4));
  const auto& m = std::get<PosePose>(file.graph.relations[0].measurement);
  EXPECT_EQ(m.T_a_b, (Pose2{1, 2, 0.5}));
  Matrix3d expected;
  expected << 11, 1, 2, 1, 22, 3, 2, 3, 33;
  EXPECT_EQ(m.information, expected);
}

TEST(GraphReader, ReadsTorosOrderOfTheSameInformation) {
  const GraphFile toro = parse_graph("EDGE2 3 4 1 2 0.5 11 1 22 33 2 3\n", "t");
  const GraphFile g2o = parse_graph("EDGE_SE2 3 4 1 2 0.5 11 1 2 22 3 33\n", "t");
  EXPECT_TRUE(toro.is_toro);
  EXPECT_EQ(std::get<PosePose>(toro.graph.relations[0].measurement).information,
            std::get<PosePose>(g2o.graph.relations[0].measurement).information);
}

TEST(GraphReader, WhatIsWrittenIsReadAgain) {
  for (const char* text :
       {"VERTEX_SE2 7 0.25 -1 3\nVERTEX_SE2 9 1 2 -0.5\nFIX 7\nEDGE_SE2 7 9 1 2 0.5 11 1 2 22 3 33\n",
        "VERTEX2 7 0.25 -1 3\nVERTEX2 9 1 2 -0.5\nEDGE2 7 9 1 2 0.5 11 1 22 33 2 3\n",
        "VERTEX_SE2 0 0 0 0\nVERTEX_XY 1 2 3\nEDGE_SE2_XY 0 1 2 3 5 1 6\nEDGE_BEARING_SE2_XY 0 1 0.5 16\n"
        "EDGE_PRIOR_SE2 0 1 2 0.5 11 1 2 22 3 33\n"}) {
    const GraphFile file = parse_graph(text, "t");
    EXPECT_THAT(file.skipped, testing::IsEmpty()) << text;
    const std::string once = to_graph_text(file, file.graph.poses);
    const GraphFile again = parse_graph(once, "t");
    EXPECT_EQ(again.ids, file.ids);
    EXPECT_EQ(again.graph.poses, file.graph.poses);
    EXPECT_EQ(again.graph.relations.size(), file.graph.relations.size());
    EXPECT_EQ(to_graph_text(again, again.graph.poses), once);
  }
}

TEST(GraphReader, WhatCannotBeUsedIsCountedWithItsFirstPlace) {
  const std::pair<const char*, const char*> bad[] = {
      {"EDGE_SE2 3 3 1 2 0.5 1 0 0 1 0 1\n", "with itself"},
      {"EDGE_SE2 3 4 1 2 nan 1 0 0 1 0 1\n", "not finite"},
      {"EDGE_SE2 3 4 1 2 0.5 1 0 0 1 0\n", "missing"},
      {"EDGE_SE2 3 4.5 1 2 0.5 1 0 0 1 0 1\n", "no ids"},
      {"EDGE_SE2 3 4 1 2 0.5 1 0 0 -1 0 1\n", "not positive semi-definite"},
      {"VERTEX_SE2 3 0 0 0\nVERTEX_SE2 3 1 0 0\n", "there before"},
      {"EDGE_SE3:QUAT 3 4\n", "not known"},
      {"VERTEX_XY 4 0 0\n", "another kind of node"}};
  for (const auto& [line, reason] : bad) {
    const GraphFile file = parse_graph(std::string("# graph\n") + line + kEdge, "bad.g2o");
    ASSERT_EQ(file.skipped.size(), 1U) << line;
    EXPECT_THAT(file.skipped[0].reason, HasSubstr(reason));
    EXPECT_EQ(file.skipped[0].count, 1U);
    EXPECT_THAT(file.skipped[0].first, HasSubstr("bad.g2o:"));
  }
}

TEST(GraphReader, OnlyRelationsOfNodesThatDoNotFollowOneAnotherMayBeWrong) {
  const GraphFile file = parse_graph("EDGE_SE2 3 4 1 2 0 1 0 0 1 0 1\nEDGE_SE2 3 5 1 2 0 1 0 0 1 0 1\n", "t");
  EXPECT_FALSE(file.graph.relations[0].may_be_wrong);
  EXPECT_TRUE(file.graph.relations[1].may_be_wrong);
}

TEST(GraphReader, AMissingFileAndOneWithoutRelationsAreRefusedWithTheReason) {
  EXPECT_FALSE(read_graph("no/such/file.g2o"));
}

// The best costs known of the recorded graphs, from wherever the fit chooses to start.
TEST(GraphReader, RecordedGraphsAreFittedToTheBestCostKnown) {
  const std::string folder = std::string(HELICOID_SOURCE_DIR) + "/../shared/data/posegraphs/";
  const std::pair<const char*, double> known[] = {{"manhattan", 3549.036796}, {"city10000", 511.985164},
                                                  {"intel", 45.004696},       {"CSAIL", 40.555129},
                                                  {"MIT", 41.163269},         {"ais2klinik", 172.815579}};
  for (const auto& [name, cost] : known) {
    Result<GraphFile> file = read_graph(folder + name + ".g2o.gz");
    if (!file) GTEST_SKIP() << "the recorded graph " << name << " is not there: the best costs were NOT checked";
    file->graph.poses = odometry_start(file->graph, file->is_placed);
    const StartedFit fitted = fit_from(file->graph, FitStart::automatic);
    EXPECT_EQ(fitted.result.status, FitStatus::converged) << name;
    EXPECT_LT(2 * fitted.result.final_cost, cost * (1 + 1e-6)) << name;
    EXPECT_TRUE(fitted.is_plausible) << name;
  }
}

}  // namespace helicoid
