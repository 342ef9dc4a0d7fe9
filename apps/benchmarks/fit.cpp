// Fits of pose graphs, against Ceres at its best setting: cost of the optimum beside CPU seconds, ordering included;
// and single Newton steps, against CHOLMOD: residual of the solution beside CPU seconds of all that a step takes once
// the system is linearised.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "apps/bench.hpp"
#include "apps/benchmarks/bench_graphs.hpp"
#include "apps/ceres_judge.hpp"
#include "helicoid/base/whole_file.hpp"
#include "helicoid/fit/cpu_clock.hpp"
#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/fit/linear_system.hpp"
#include "helicoid/io/graph_reader.hpp"

namespace helicoid {

namespace {

/// What a judge printed of the same graph and start, run by run.
Result<std::vector<std::vector<double>>> ask(const char* judge_name, const GraphFile& file,
                                             const BenchOptions& options) {
  const std::string path = (std::filesystem::temp_directory_path() / "helicoid_bench_fit.g2o").string();
  if (auto done = write_whole_file(path, to_graph_text(file, file.graph.poses)); !done)
    return tl::unexpected(done.error());
  std::vector<std::vector<double>> runs;
  for (int i = 0; i < options.repeats; ++i) {
    FILE* pipe = popen(("'" + judge_beside(options.program, judge_name) + "' " + path).c_str(), "r");
    if (pipe == nullptr) return fail("{} could not be started", judge_name);
    runs.emplace_back();
    for (double number = 0; std::fscanf(pipe, "%lf", &number) == 1;) runs.back().push_back(number);
    if (pclose(pipe) != 0 || runs.back().size() < 3) return fail("{} failed on {}", judge_name, path);
  }
  std::filesystem::remove(path);
  return runs;
}

/// The run of Ceres that took least CPU time, on the same graph and start.
Result<Judged> judge_repeatedly(const GraphFile& file, const BenchOptions& options) {
  Result<Judged> best = judge(file, options.program);
  for (int i = 1; i < options.repeats && best; ++i) {
    Result<Judged> one = judge(file, options.program);
    if (!one || one->cpu_s < best->cpu_s) best = std::move(one);
  }
  return best;
}

/// One Newton step: ordering, symbolic phase, factorisation and solution.
struct Step {
  double residual = 0;
  double order_s = 0;
  double factorise_s = 0;
  double solve_s = 1e300;

  [[nodiscard]] double total_s() const { return order_s + factorise_s + solve_s; }
};

Step take_step(const RelationGraph& graph) {
  Step step;
  const double began = CpuTimer::now();
  LinearSystem system(graph, default_gauge(graph));
  step.order_s = CpuTimer::now() - began;
  system.linearise(graph.poses);
  const double linearised = CpuTimer::now();
  system.factorise();
  const double factorised = CpuTimer::now();
  std::vector<double> x(system.gradient().begin(), system.gradient().end());
  system.solve(x);
  step.factorise_s = factorised - linearised;
  step.solve_s = CpuTimer::now() - factorised;
  step.residual = relative_residual(system.information(), x, system.gradient());
  return step;
}

Result<BenchRow> measure_step(const std::string& name, const GraphFile& file, const BenchOptions& options) {
  Step ours;
  for (int i = 0; i < options.repeats; ++i) {
    const Step one = take_step(file.graph);
    if (one.total_s() < ours.total_s()) ours = one;
  }
  const auto runs = ask("cholmod_judge", file, options);
  if (!runs) return tl::unexpected(runs.error());
  Step theirs;
  for (const std::vector<double>& run : *runs) {
    const Step one{run[0], run[1], run[2], run.at(3)};
    if (one.total_s() < theirs.total_s()) theirs = one;
  }
  BenchRow row;
  row.name = name;
  row.quality_unit = "of residual";
  row.cost_unit = "CPU s";
  row.ours = {"helicoid", ours.residual, ours.total_s()};
  row.baseline = {"CHOLMOD", theirs.residual, theirs.total_s()};
  row.note =
      fmt::format("{:.1f} times faster; order {:.4f} and {:.4f}, factorise {:.4f} and {:.4f}, solve {:.4f} and {:.4f}",
                  theirs.total_s() / ours.total_s(), ours.order_s, theirs.order_s, ours.factorise_s, theirs.factorise_s,
                  ours.solve_s, theirs.solve_s);
  return row;
}

Result<BenchRow> measure_fit(const std::string& name, const GraphFile& file, const BenchOptions& options) {
  FitResult fitted;
  FitTimes best;
  best.total_s = 1e300;
  for (int i = 0; i < options.repeats; ++i) {
    fitted = fit(file.graph);
    if (fitted.times.total_s < best.total_s) best = fitted.times;
  }
  const Result<Judged> judged = judge_repeatedly(file, options);
  if (!judged) return tl::unexpected(judged.error());
  BenchRow row;
  row.name = name;
  row.quality_unit = "of cost";
  row.cost_unit = "CPU s";
  row.ours = {"helicoid", 2 * fitted.final_cost, best.total_s};
  row.baseline = {"Ceres", judged->cost, judged->cpu_s};
  row.note = fmt::format(
      "{:.1f} times faster; {} and {} iterations; order {:.4f}, linearise {:.4f}, factorise {:.4f}, solve {:.4f}",
      judged->cpu_s / best.total_s, fitted.iterations, judged->iterations, best.order_s, best.linearise_s,
      best.factorise_s, best.solve_s);
  return row;
}

/// Beside the bar of issue 3, since Ceres needs more memory than many machines have.
Result<BenchRow> measure_large(const std::string& name, std::uint32_t side) {
  const GraphFile file = make_grid(side);
  const FitResult fitted = fit(file.graph);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  BenchRow row;
  row.name = name;
  row.quality_unit = "GB of peak memory, graph included";
  row.cost_unit = "CPU s";
  row.ours = {"helicoid", 1024e-9 * static_cast<double>(usage.ru_maxrss), fitted.times.total_s};
  row.baseline = {"the bar", 4, 120};
  row.note =
      fmt::format("cost {:.6f}; {} relations; {} iterations; order {:.2f}, factorise {:.2f}", 2 * fitted.final_cost,
                  file.graph.relations.size(), fitted.iterations, fitted.times.order_s, fitted.times.factorise_s);
  return row;
}

/// The whole fit beside Ceres and one of its steps beside CHOLMOD.
void add_both(std::vector<Benchmark>& all, const std::string& name, const std::string& missing,
              const std::function<Result<GraphFile>()>& read, const BenchOptions& options) {
  const auto without = [&](const char* judge_name, const char* library) {
    if (!missing.empty() || std::filesystem::exists(judge_beside(options.program, judge_name))) return missing;
    return fmt::format("{} was not there when this was built", library);
  };
  const auto on_graph = [read, options](const std::string& row,
                                        const auto& measure) -> std::function<Result<BenchRow>()> {
    return [=]() -> Result<BenchRow> {
      const Result<GraphFile> file = read();
      if (!file) return tl::unexpected(file.error());
      return measure(row, *file, options);
    };
  };
  all.push_back(
      {"fit " + name, without("ceres_judge", "Ceres (Debian: libceres-dev)"), on_graph("fit " + name, measure_fit)});
  all.push_back({"step of fit " + name, without("cholmod_judge", "CHOLMOD (Debian: libsuitesparse-dev)"),
                 on_graph("step of fit " + name, measure_step)});
}

}  // namespace

std::vector<Benchmark> fit_benchmarks(const BenchOptions& options) {
  std::vector<Benchmark> all;
  for (const char* name : {"manhattan", "city10000", "intel"}) {
    const bool there = std::filesystem::exists(options.data + "/posegraphs/" + name + ".g2o.gz");
    add_both(
        all, name, there ? "" : "no recorded data", [=] { return read_recorded(name, options); }, options);
  }
  for (const std::uint32_t side : {100U, 316U}) {
    BenchOptions repeated = options;
    if (side > 200) repeated.repeats = 1;
    add_both(
        all, fmt::format("grid {}", side * side), "", [=]() -> Result<GraphFile> { return make_grid(side); }, repeated);
  }
  constexpr std::uint32_t kLargeSide = 1000;
  const std::string large = fmt::format("fit grid {}", kLargeSide * kLargeSide);
  all.push_back({large, options.large ? "" : "needs a minute and 4 GB; --large asks for it",
                 [large] { return measure_large(large, kLargeSide); }});
  return all;
}

}  // namespace helicoid
