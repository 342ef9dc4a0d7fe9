// helicoid fit as its users run it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "helicoid/io/graph_reader.hpp"
#include "tests/program.hpp"
#include "tests/random_graph.hpp"

namespace helicoid::program {

namespace {

using testing::HasSubstr;

/// A g2o graph of a robot's way with closures; its start is off.
std::string graph_text(bool is_toro, const std::string& more = "") {
  GraphFile file;
  file.graph = random_graph(3, 40, 30);
  file.is_toro = is_toro;
  for (std::size_t i = 0; i < file.graph.poses.size(); ++i) file.ids.push_back(static_cast<std::int64_t>(10 + i));
  return to_graph_text(file, file.graph.poses) + more;
}

nlohmann::json fit_json(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "fit");
  arguments.emplace_back("--json");
  const Ended ended = run(arguments);
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  return nlohmann::json::parse(ended.out);
}

double final_cost(const std::vector<std::string>& arguments) {
  return fit_json(arguments)["final_cost"].get<double>();
}

}  // namespace

TEST(FitVerb, AFittedGraphIsReadAgainAtItsOptimumInEitherFormat) {
  const Sandbox box;
  for (const bool is_toro : {false, true}) {
    const std::string graph = box.write("in", graph_text(is_toro));
    const double cost = final_cost({graph, "--out", box / "out"});
    EXPECT_THAT(bytes_of(box / "out"), HasSubstr(is_toro ? "\nEDGE2 " : "\nEDGE_SE2 "));
    const nlohmann::json again = fit_json({box / "out", "--init", "file"});
    EXPECT_NEAR(again["initial_cost"].get<double>(), cost, 1e-6 * cost);
    EXPECT_LE(again["iterations"].get<int>(), 1);
  }
}

TEST(FitVerb, EveryMethodAndStartEndsAtOneCost) {
  const Sandbox box;
  const std::string graph = box.write("graph", graph_text(false));
  const double cost = final_cost({graph});
  for (const char* method : {"lm", "fr", "gd"}) EXPECT_NEAR(final_cost({graph, "--method", method}), cost, 1e-6 * cost);
  for (const char* start : {"file", "odometry", "chordal", "auto"})
    EXPECT_NEAR(final_cost({graph, "--init", start}), cost, 1e-6 * cost);
}

TEST(FitVerb, NodesOfFixLinesStayWhereTheyAreFromEveryStart) {
  const Sandbox box;
  const std::string graph = box.write("graph", graph_text(false, "FIX 14\nFIX 30\n"));
  const GraphFile before = *read_graph(graph);
  for (const char* start : {"file", "odometry", "chordal", "auto"}) {
    fit_json({graph, "--init", start, "--out", box / "out"});
    const GraphFile after = *read_graph(box / "out");
    for (const std::size_t node : {4U, 20U}) EXPECT_EQ(after.graph.poses[node], before.graph.poses[node]) << start;
    EXPECT_NE(after.graph.poses[0], before.graph.poses[0]) << start;
  }
  // Whoever alone is held changes no cost; two that are held where they stand do.
  const double cost = final_cost({box.write("free", graph_text(false))});
  EXPECT_NEAR(final_cost({box.write("one", graph_text(false, "FIX 14\n"))}), cost, 1e-6 * cost);
  EXPECT_GT(final_cost({graph}), 1.01 * cost);
}

TEST(FitVerb, AFitThatDoesNotConvergeEndsWith3) {
  const Sandbox box;
  const std::string graph = box.write("graph", graph_text(false));
  const Ended ended = run({"fit", graph, "--init", "file", "--max-iterations", "1"});
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_THAT(ended.out, HasSubstr("iteration limit"));
}

TEST(FitVerb, ErrorsNameThePlaceAndTheMend) {
  const Sandbox box;
  const std::string graph = box.write("graph", graph_text(false));
  const std::string apart = box.write("apart", graph_text(false, "EDGE_SE2 70 71 1 0 0 1 0 0 1 0 1\n"));
  const std::string empty = box.write("empty", "VERTEX_SE2 0 0 0 0\n");
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{box / "missing.g2o"}, "missing.g2o"},
      {{empty}, "holds no relation; a g2o graph has lines `EDGE_SE2"},
      {{graph, "--confidence", box / "s", "--relative-to", "7"},
       "7: no node of the graph; name one with --relative-to"},
      {{apart, "--confidence", box / "s"}, "2 components: nothing is known between them"},
      {{graph, "--out", box / "no/such/folder"}, "no/such/folder"},
  };
  for (const auto& [arguments, message] : wrong) {
    std::vector<std::string> all = arguments;
    all.insert(all.begin(), "fit");
    const Ended ended = run(all);
    EXPECT_EQ(ended.exit_code, 1) << message;
    EXPECT_THAT(ended.err, HasSubstr(message));
  }
}

TEST(FitVerb, AnOptimumThatMayBeLocalIsCalledSo) {
  const Sandbox box;
  EXPECT_EQ(fit_json({box.write("good", graph_text(false))})["optimum"], "consistent with the stated noise");
  // A closure that contradicts all others.
  const std::string bad = box.write("bad", graph_text(false, "EDGE_SE2 10 45 5 5 1 1 0 0 1 0 1\n"));
  EXPECT_EQ(fit_json({bad})["optimum"], "may be local");
  EXPECT_EQ(fit_json({bad, "--loss", "truncated"})["wrong_relations"], 1);
}

}  // namespace helicoid::program
