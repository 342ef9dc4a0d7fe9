// Does the incremental fit keep up with a growing graph?
#include <algorithm>
#include <filesystem>

#include "apps/experiments/list.hpp"
#include "helicoid/fit/cpu_clock.hpp"
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

struct Playback {
  double total_s = 0, worst_s = 0, worst_excess = 0, last_excess = 0;
  std::size_t worst_step = 0, waiting = 0, eliminated = 0, relinearised = 0, undetermined = 0;
};

/// What the incremental fit made of the first poses.
struct Snapshot {
  std::vector<Pose2> poses;
  double cost = 0;
};

/// Holds the snapshots against batch fits: afterwards, so that no step finds the caches full of a judge's work.
void judge(const std::vector<std::vector<GraphRelation>>& steps, const std::vector<Snapshot>& snapshots, Playback& p) {
  RelationGraph so_far;
  std::size_t node = 0;
  for (const Snapshot& s : snapshots) {
    for (; node < s.poses.size(); ++node)
      so_far.relations.insert(so_far.relations.end(), steps[node].begin(), steps[node].end());
    so_far.poses = s.poses;
    // Chains that nothing contradicts cost nothing: a share of nothing says nothing.
    p.last_excess = 100 * (s.cost / std::max(fit(so_far).final_cost, 1e-3) - 1);
    p.worst_excess = std::max(p.worst_excess, p.last_excess);
  }
}

Playback play(const RelationGraph& graph) {
  Playback p;
  const auto steps = steps_of(graph);
  IncrementalFit fitted;
  std::vector<Snapshot> snapshots;
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
    }
    p.total_s += seconds;
    if (seconds > p.worst_s) p.worst_step = node;
    p.worst_s = std::max(p.worst_s, seconds);
    const bool is_last = node + 1 == steps.size();
    if (is_last || (node % 100 == 0 && node > 0)) {
      snapshots.push_back({fitted.poses(), fitted.cost()});
    }
  }
  judge(steps, snapshots, p);
  return p;
}

/// `allowed_s`: CPU seconds for the whole graph.
Result<Outcome> measure(const std::string& path, double allowed_s) {
  const Result<GraphFile> file = read_graph(path);
  if (!file) return tl::unexpected(file.error());
  const Playback p = play(file->graph);
  const auto count = static_cast<double>(file->graph.poses.size());
  return Outcome{{{"worst_excess_cost_percent", p.worst_excess},
                  {"last_excess_cost_percent", p.last_excess},
                  {"worst_step_ms", 1e3 * p.worst_s},
                  {"worst_step_index", static_cast<double>(p.worst_step)},
                  {"total_cpu_s", p.total_s},
                  {"share_of_allowed_cpu_percent", 100 * p.total_s / allowed_s},
                  {"per_pose_ms", 1e3 * p.total_s / count},
                  {"eliminated_a_step_count", static_cast<double>(p.eliminated) / count},
                  {"relinearised_a_step_count", static_cast<double>(p.relinearised) / count},
                  {"most_waiting_count", static_cast<double>(p.waiting)},
                  {"undetermined_steps_count", static_cast<double>(p.undetermined)}},
                 {}};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  const std::pair<const char*, double> graphs[] = {{"manhattan", 2.0}, {"city10000", 20.0}};
  for (const auto& [name, allowed_s] : graphs) {
    if (options.quick && cases.size() == 1) break;
    const std::string path = options.data + "/posegraphs/" + name + ".g2o.gz";
    std::error_code error;
    ExperimentCase c{name, false, "", [path, allowed = allowed_s](std::uint64_t) { return measure(path, allowed); }};
    if (options.data.empty() || !std::filesystem::exists(path, error))
      c.missing = fmt::format("the recorded graph posegraphs/{}.g2o.gz is not there; --data names its folder", name);
    cases.push_back(std::move(c));
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
      "of those puts it. CPU time is taken of each step; all together may take 2 s for manhattan and 20 s for "
      "city10000. At every hundredth step and the last the cost is held "
      "against that of a batch fit of the same relations from the same poses.";
  e.bars = {{"worst_excess_cost_percent", std::nullopt, 1.0, false},
            {"worst_step_ms", std::nullopt, 20.0, false},
            {"share_of_allowed_cpu_percent", std::nullopt, 100.0, false}};
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
