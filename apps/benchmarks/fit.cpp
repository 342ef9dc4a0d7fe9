// Fits of pose graphs, against Ceres at its best setting: cost of the optimum beside CPU seconds, ordering included.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "apps/bench.hpp"
#include "helicoid/base/random.hpp"
#include "helicoid/base/whole_file.hpp"
#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/fit/initial_guess.hpp"
#include "helicoid/io/graph_reader.hpp"

namespace helicoid {

namespace {

/// A path to and fro over a square grid, a metre a step, with a relation to the neighbour in the row before.
GraphFile make_grid(std::uint32_t side) {
  Random random(side);
  GraphFile file;
  std::vector<Pose2> truth;
  const auto at = [side](std::uint32_t row, std::uint32_t column) {
    return row * side + (row % 2 == 0 ? column : side - 1 - column);
  };
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const std::uint32_t row = i / side;
    const std::uint32_t column = row % 2 == 0 ? i % side : side - 1 - i % side;
    truth.push_back({static_cast<double>(column), static_cast<double>(row), row % 2 == 0 ? 0.0 : radians(180)});
    file.ids.push_back(i);
  }
  const Matrix3d information = Vector3d(400, 400, 3000).asDiagonal();
  const auto relate = [&](std::uint32_t a, std::uint32_t b) {
    const Pose2 noise{0.05 * random.normal(), 0.05 * random.normal(), 0.018 * random.normal()};
    file.graph.relations.push_back({a, b, PosePose{truth[a].inverse() * truth[b] * noise, information}, b != a + 1});
  };
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      const std::uint32_t i = row * side + column;
      if (i > 0) relate(i - 1, i);
      if (row > 0 && at(row - 1, column) + 1 != at(row, column)) relate(at(row - 1, column), at(row, column));
    }
  }
  // As an online mapper would start: near.
  for (const Pose2& T : truth) {
    file.graph.poses.push_back(T * Pose2{0.2 * random.normal(), 0.2 * random.normal(), 0.05 * random.normal()});
  }
  return file;
}

std::string judge_beside(const std::string& program) {
  return (std::filesystem::path(program).parent_path().parent_path() / "bench" / "ceres_judge").string();
}

struct Judged {
  double cost = 0;
  double seconds = 1e300;
  int iterations = 0;
};

/// The least CPU time of the judge's runs on the same graph and start.
Result<Judged> judge(const GraphFile& file, const BenchOptions& options, int repeats) {
  const std::string path = (std::filesystem::temp_directory_path() / "helicoid_bench_fit.g2o").string();
  if (auto done = write_whole_file(path, to_graph_text(file, file.graph.poses)); !done)
    return tl::unexpected(done.error());
  Judged best;
  for (int i = 0; i < repeats; ++i) {
    FILE* pipe = popen(("'" + judge_beside(options.program) + "' " + path).c_str(), "r");
    if (pipe == nullptr) return fail("the judge could not be started");
    Judged one;
    const int read = std::fscanf(pipe, "%lf %lf %d", &one.cost, &one.seconds, &one.iterations);
    if (pclose(pipe) != 0 || read != 3) return fail("the judge failed on {}", path);
    if (one.seconds < best.seconds) best = one;
  }
  std::filesystem::remove(path);
  return best;
}

Result<BenchRow> measure(const std::string& name, const GraphFile& file, const BenchOptions& options, int repeats) {
  FitResult fitted;
  FitTimes best;
  best.total_s = 1e300;
  for (int i = 0; i < repeats; ++i) {
    fitted = fit(file.graph);
    if (fitted.times.total_s < best.total_s) best = fitted.times;
  }
  const Result<Judged> judged = judge(file, options, repeats);
  if (!judged) return tl::unexpected(judged.error());
  BenchRow row;
  row.name = name;
  row.quality_unit = "of cost";
  row.cost_unit = "CPU s";
  row.ours = {"helicoid", 2 * fitted.final_cost, best.total_s};
  row.baseline = {"Ceres", judged->cost, judged->seconds};
  row.note = fmt::format(
      "{:.1f} times faster; {} and {} iterations; order {:.4f}, linearise {:.4f}, factorise {:.4f}, solve {:.4f}",
      judged->seconds / best.total_s, fitted.iterations, judged->iterations, best.order_s, best.linearise_s,
      best.factorise_s, best.solve_s);
  return row;
}

Result<BenchRow> measure_recorded(const std::string& name, const BenchOptions& options) {
  Result<GraphFile> file = read_graph(options.data + "/posegraphs/" + name + ".g2o.gz");
  if (!file) return tl::unexpected(file.error());
  file->graph.poses = odometry_start(file->graph, file->is_placed);
  return measure("fit " + name, *file, options, options.repeats);
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

}  // namespace

std::vector<Benchmark> fit_benchmarks(const BenchOptions& options) {
  std::vector<Benchmark> all;
  const bool has_judge = std::filesystem::exists(judge_beside(options.program));
  const std::string no_judge = has_judge ? "" : "Ceres was not there when this was built (Debian: libceres-dev)";
  for (const char* name : {"manhattan", "city10000", "intel"}) {
    const bool there = std::filesystem::exists(options.data + "/posegraphs/" + name + ".g2o.gz");
    all.push_back({std::string("fit ") + name, there ? no_judge : "no recorded data",
                   [name, options] { return measure_recorded(name, options); }});
  }
  for (const std::uint32_t side : {100U, 316U}) {
    const std::string name = fmt::format("fit grid {}", side * side);
    all.push_back({name, no_judge, [name, side, options] {
                     return measure(name, make_grid(side), options, side > 200 ? 1 : options.repeats);
                   }});
  }
  constexpr std::uint32_t kLargeSide = 1000;
  const std::string large = fmt::format("fit grid {}", kLargeSide * kLargeSide);
  all.push_back({large, options.large ? "" : "needs a minute and 4 GB; --large asks for it",
                 [large] { return measure_large(large, kLargeSide); }});
  return all;
}

}  // namespace helicoid
