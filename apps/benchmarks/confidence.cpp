// How well all poses of a graph are known relative to one (eq. 9-10): CPU seconds from the fitted poses on, ordering
// and factorisation included, and how far the answers are from those of single solves.
#include <functional>

#include "apps/benchmarks/bench_graphs.hpp"
#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/fit/relative_covariance.hpp"

namespace helicoid {

namespace {

/// Beside the bar of issue 3.
Result<BenchRow> measure(const std::string& name, GraphFile file, double allowed_s, const BenchOptions& options) {
  file.graph.poses = fit(file.graph).poses;
  std::vector<UncertainPose2> all;
  const double seconds = least_cpu_seconds(options.repeats, [&] {
    RelativeCovariance covariance(file.graph);
    all = covariance.relative_to(0);
  });
  const RelativeCovariance covariance(file.graph);
  double worst = 0;
  constexpr std::size_t kSolves = 100;
  for (std::size_t k = 1; k <= kSolves; ++k) {
    const auto b = static_cast<std::uint32_t>(k * (all.size() - 1) / kSolves);
    const Matrix3d expected = covariance.of(0, b).covariance;
    worst = std::max(worst, (all[b].covariance - expected).norm() / expected.norm());
  }
  BenchRow row;
  row.name = name;
  row.quality_unit = "of difference from single solves, relative";
  row.cost_unit = "CPU s";
  row.ours = {"helicoid", worst, seconds};
  row.baseline = {"the bar", 1e-8, allowed_s};
  row.note = fmt::format("{} poses", all.size());
  return row;
}

}  // namespace

std::vector<Benchmark> confidence_benchmarks(const BenchOptions& options) {
  std::vector<Benchmark> all;
  const std::string city = "confidence city10000";
  all.push_back({city, is_recorded("city10000", options) ? "" : "no recorded data", [=]() -> Result<BenchRow> {
                   Result<GraphFile> file = read_recorded("city10000", options);
                   if (!file) return tl::unexpected(file.error());
                   return measure(city, std::move(*file), 0.1, options);
                 }});
  constexpr std::uint32_t kSide = 316;
  const std::string grid = fmt::format("confidence grid {}", kSide * kSide);
  all.push_back({grid, "", [=] { return measure(grid, make_grid(kSide), 3, options); }});
  return all;
}

}  // namespace helicoid
