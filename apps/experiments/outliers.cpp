// Does the robust fit let wrong loop closures go?
#include <cmath>
#include <map>

#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "helicoid/base/random.hpp"
#include "helicoid/fit/initial_guess.hpp"
#include "helicoid/fit/robust_fit.hpp"
#include "helicoid/io/graph_reader.hpp"

namespace helicoid {

namespace {

/// As many wrong closures as there are right ones, each with the information of one of those; `group` of them in a row
/// agree with one another.
std::size_t add_wrong_closures(RelationGraph& graph, Random random, std::uint32_t group) {
  std::vector<std::size_t> right;
  for (std::size_t i = 0; i < graph.relations.size(); ++i) {
    if (graph.relations[i].may_be_wrong) right.push_back(i);
  }
  const auto count = static_cast<std::uint32_t>(graph.poses.size());
  std::size_t added = 0;
  while (added < right.size()) {
    const auto a = static_cast<std::uint32_t>(random.below(count - group));
    const auto b = static_cast<std::uint32_t>(random.below(count - group));
    if (a < b + 2 * group && b < a + 2 * group) continue;
    const Pose2 wrong{random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-3, 3)};
    for (std::uint32_t k = 0; k < group && added < right.size(); ++k, ++added) {
      // Where the two stretches are led past one another as rigid bodies, all closures say the same.
      const Pose2 T_a_ak = graph.poses[a].inverse() * graph.poses[a + k];
      const Pose2 T_b_bk = graph.poses[b].inverse() * graph.poses[b + k];
      const auto& like = std::get<PosePose>(graph.relations[right[random.below(right.size())]].measurement);
      graph.relations.push_back({a + k, b + k, PosePose{T_a_ak.inverse() * wrong * T_b_bk, like.information}, true});
    }
  }
  return added;
}

double cost_of(const RelationGraph& graph, const std::vector<Pose2>& poses) {
  double sum = 0;
  for (const GraphRelation& r : graph.relations) {
    sum += cost(r.measurement, RelativePose::of(poses[r.a].inverse() * poses[r.b]));
  }
  return sum;
}

/// A random walk along the streets of a square town, four metres a block, measured with the noise that is stated. Where
/// it comes by again half of the poses there are recognised, two at most.
RelationGraph walk(std::uint64_t seed) {
  constexpr std::uint32_t kPoses = 1000;
  constexpr double kHalf = 10;  // metres
  Random random(seed);
  RelationGraph graph;
  std::vector<Pose2> truth(1);
  std::map<std::pair<long, long>, std::vector<std::uint32_t>> seen;
  const Matrix3d information = Vector3d(1 / 0.0009, 1 / 0.0009, 1 / 0.0001).asDiagonal();
  const auto relate = [&](std::uint32_t a, std::uint32_t b, bool may_be_wrong) {
    const Pose2 noise{0.03 * random.normal(), 0.03 * random.normal(), 0.01 * random.normal()};
    graph.relations.push_back({a, b, PosePose{truth[a].inverse() * truth[b] * noise, information}, may_be_wrong});
  };
  for (std::uint32_t i = 1; i < kPoses; ++i) {
    const double turn = i % 4 == 0 ? radians(90) * (static_cast<double>(random.below(3)) - 1) : 0;
    Pose2 next = truth.back() * Pose2{1, 0, turn};
    if (std::max(std::abs(next.x), std::abs(next.y)) > kHalf) next = truth.back() * Pose2{0, 0, radians(180)};
    truth.push_back(next);
    relate(i - 1, i, false);
    auto& here = seen[{std::lround(next.x), std::lround(next.y)}];
    int found = 0;
    for (auto old = here.rbegin(); old != here.rend() && found < 2; ++old) {
      if (*old + 10 < i && random.below(2) == 0) relate(*old, i, true), ++found;
    }
    here.push_back(i);
  }
  graph.poses.resize(kPoses);
  graph.poses = odometry_start(graph);
  return graph;
}

Result<RelationGraph> read(const std::string& path) {
  Result<GraphFile> file = read_graph(path);
  if (!file) return tl::unexpected(file.error());
  file->graph.poses = odometry_start(file->graph, file->is_placed);
  return std::move(file->graph);
}

Outcome measure(const RelationGraph& clean, std::uint64_t seed, std::uint32_t group) {
  const FitResult best = fit(clean);
  RelationGraph wrong = clean;
  wrong.poses = best.poses;
  const std::size_t added = add_wrong_closures(wrong, Random(seed), group);
  wrong.poses = clean.poses;
  FitOptions options;
  options.loss.kind = LossKind::truncated;
  const RobustFit robust = fit_robustly(wrong, default_gauge(wrong), options);
  std::size_t found = 0;
  for (const std::uint32_t i : robust.wrong) found += i >= clean.relations.size() ? 1 : 0;
  const double excess = 100 * (cost_of(clean, robust.result.poses) / best.final_cost - 1);
  const double none = 100 * (cost_of(clean, fit(wrong).poses) / best.final_cost - 1);
  return Outcome{{{"excess_cost_percent", excess},
                  {"excess_cost_without_robust_loss_percent", none},
                  {"wrong_kept_count", static_cast<double>(added - found)},
                  {"right_dropped_count", static_cast<double>(robust.wrong.size() - found)},
                  {"cpu_s", robust.result.times.total_s}},
                 {}};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  for (const std::uint32_t group : {1U, 10U}) {
    cases.push_back({fmt::format("walk {}", group == 1 ? "random" : "grouped"), true, "",
                     [group](std::uint64_t seed) -> Result<Outcome> { return measure(walk(seed), seed, group); }});
  }
  for (const char* name : {"manhattan", "intel"}) {
    const std::string graph = fmt::format("posegraphs/{}.g2o.gz", name);
    for (const std::uint32_t group : {1U, 10U}) {
      ExperimentCase c{
          fmt::format("{} {}", name, group == 1 ? "random" : "grouped"), true, missing_data(options, graph), {}};
      c.run = [path = options.data + "/" + graph, group](std::uint64_t seed) -> Result<Outcome> {
        const Result<RelationGraph> clean = read(path);
        if (!clean) return tl::unexpected(clean.error());
        return measure(*clean, seed, group);
      };
      cases.push_back(std::move(c));
    }
  }
  return cases;
}

}  // namespace

Experiment outliers_experiment() {
  Experiment e;
  e.name = "outliers";
  e.question = "Does the robust fit let wrong loop closures go?";
  e.method =
      "To each graph, recorded or walked at random, as many wrong closures are added as it has right ones, with the "
      "information of right ones: between random nodes, or in groups of ten that agree with one another. The fit with "
      "the truncated loss starts from dead reckoning and must find the right ones by itself. What counts is the cost "
      "of the clean graph at the poses found, beside that of its own optimum.";
  e.bars = {{"excess_cost_percent", std::nullopt, 5.0, false}};
  e.seeds = 5;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
