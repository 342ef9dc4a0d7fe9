// Does the incremental fit keep up with a growing graph?
#include <algorithm>

#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "helicoid/fit/cpu_clock.hpp"
#include "helicoid/fit/fit_from_start.hpp"
#include "helicoid/fit/incremental_fit.hpp"
#include "helicoid/io/graph_reader.hpp"

namespace helicoid {

namespace {

/// The relations of each pose to earlier ones, in the file's order.
std::vector<std::vector<GraphRelation>> steps_of(const RelationGraph& graph) {
  std::vector<std::vector<GraphRelation>> steps(graph.poses.size());
  for (const GraphRelation& r : graph.relations) {
    steps[r.a == kWorld ? r.b : std::max(r.a, r.b)].push_back(r);
  }
  return steps;
}

/// Where the first pose-pose relation to an earlier pose puts the new one.
Pose2 predict(const std::vector<GraphRelation>& step, std::uint32_t node, const IncrementalFit& fitted) {
  for (const GraphRelation& r : step) {
    const auto* m = std::get_if<PosePose>(&r.measurement);
    if (m == nullptr || r.a == kWorld) continue;
    return r.b == node ? fitted.pose(r.a) * m->T_a_b : fitted.pose(r.b) * m->T_a_b.inverse();
  }
  return {};
}

/// What the incremental fit made of the first poses.
struct Snapshot {
  std::vector<Pose2> poses;
  double cost = 0;
};

struct Played {
  std::vector<double> step_s;  ///< CPU seconds
  std::vector<Snapshot> snapshots;
  std::size_t waiting = 0, eliminated = 0, relinearised = 0, undetermined = 0, solved_fully = 0;
};

struct Excess {
  double worst_percent = 0, last_percent = 0;
};

/// Holds the snapshots against batch fits: afterwards, so that no step finds the caches full of a judge's work.
Excess judge(const std::vector<std::vector<GraphRelation>>& steps, const std::vector<Snapshot>& snapshots) {
  Excess excess;
  RelationGraph so_far;
  std::size_t node = 0;
  for (const Snapshot& s : snapshots) {
    for (; node < s.poses.size(); ++node)
      so_far.relations.insert(so_far.relations.end(), steps[node].begin(), steps[node].end());
    so_far.poses = s.poses;
    // Chains that nothing contradicts cost nothing: a share of nothing says nothing.
    const double best = fit_from(so_far, FitStart::automatic).result.final_cost;
    excess.last_percent = 100 * (s.cost / std::max(best, 1e-3) - 1);
    excess.worst_percent = std::max(excess.worst_percent, excess.last_percent);
  }
  return excess;
}

Played play(const std::vector<std::vector<GraphRelation>>& steps) {
  Played p;
  IncrementalFit fitted;
  for (std::uint32_t node = 0; node < steps.size(); ++node) {
    double seconds = 0;
    {
      const CpuTimer timer(seconds);
      fitted.add_pose(predict(steps[node], node, fitted));
      if (node == 0) fitted.hold(0);
      for (const GraphRelation& r : steps[node]) fitted.add_relation(r);
      const IncrementalStep step = fitted.update();
      p.waiting = std::max(p.waiting, step.waiting);
      p.eliminated += step.eliminated;
      p.relinearised += step.relinearised;
      p.undetermined += step.is_determined ? 0 : 1;
      p.solved_fully += step.solved_fully ? 1 : 0;
    }
    p.step_s.push_back(seconds);
    const bool is_last = node + 1 == steps.size();
    if (is_last || (node % 100 == 0 && node > 0)) p.snapshots.push_back({fitted.poses(), fitted.cost()});
  }
  return p;
}

/// `allowed_s`: CPU seconds for the whole graph.
Result<Outcome> measure(const std::string& path, double allowed_s) {
  const Result<GraphFile> file = read_graph(path);
  if (!file) return tl::unexpected(file.error());
  const auto steps = steps_of(file->graph);
  Played p = play(steps);
  // The work of a step is the same each time; what it takes longer is other programs' doing.
  const Played again = play(steps);
  double total_s = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    p.step_s[i] = std::min(p.step_s[i], again.step_s[i]);
    total_s += p.step_s[i];
  }
  const auto worst = std::max_element(p.step_s.begin(), p.step_s.end());
  const Excess excess = judge(steps, p.snapshots);
  const auto count = static_cast<double>(steps.size());
  return Outcome{{{"worst_excess_cost_percent", excess.worst_percent},
                  {"last_excess_cost_percent", excess.last_percent},
                  {"final_cost_chi2", 2 * p.snapshots.back().cost},
                  {"worst_step_ms", 1e3 * *worst},
                  {"worst_step_index", static_cast<double>(worst - p.step_s.begin())},
                  {"total_cpu_s", total_s},
                  {"share_of_allowed_cpu_percent", 100 * total_s / allowed_s},
                  {"eliminated_a_step_count", static_cast<double>(p.eliminated) / count},
                  {"relinearised_a_step_count", static_cast<double>(p.relinearised) / count},
                  {"most_waiting_count", static_cast<double>(p.waiting)},
                  {"undetermined_steps_count", static_cast<double>(p.undetermined)},
                  {"full_solves_count", static_cast<double>(p.solved_fully)}},
                 {}};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  const std::pair<const char*, double> graphs[] = {{"manhattan", 2.0}, {"city10000", 20.0}};
  for (const auto& [name, allowed_s] : graphs) {
    if (options.quick && cases.size() == 1) break;
    const std::string graph = fmt::format("posegraphs/{}.g2o.gz", name);
    cases.push_back(
        {name, false, missing_data(options, graph),
         [path = options.data + "/" + graph, allowed = allowed_s](std::uint64_t) { return measure(path, allowed); }});
  }
  return cases;
}

}  // namespace

Experiment playback_experiment() {
  Experiment e;
  e.name = "playback";
  e.question = "Does the incremental fit keep up with a growing graph?";
  e.method =
      "The poses of each recorded graph come one a step, each with all its relations to earlier poses and where the "
      "first "
      "of those puts it. CPU time is taken of each step, the lesser of two runs of the same work; all together may "
      "take 2 s for manhattan and 20 s for "
      "city10000. At every hundredth step and the last the cost is held "
      "against that of a batch fit of the same relations from the same poses.";
  e.bars = {{"worst_excess_cost_percent", std::nullopt, 1.0, false},
            {"worst_step_ms", std::nullopt, 20.0, false, true},
            {"share_of_allowed_cpu_percent", std::nullopt, 100.0, false, true}};
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
