// helicoid bench: quality beside time.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/bench.hpp"
#include "apps/ceres_judge.hpp"
#include "apps/progress_bar.hpp"
#include "apps/repository.hpp"
#include "apps/verb.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

struct BenchArguments {
  BenchOptions options;
  std::string filter;
  std::string measured_lap;
  bool json = false;
};

Json to_json(const BenchRow& row) {
  const auto side = [](const BenchSide& s) { return Json{{"name", s.name}, {"quality", s.quality}, {"cost", s.cost}}; };
  return {{"name", row.name},       {"quality_unit", row.quality_unit}, {"cost_unit", row.cost_unit},
          {"ours", side(row.ours)}, {"baseline", side(row.baseline)},   {"note", row.note}};
}

void print_row(const BenchRow& row) {
  const auto side = [](const BenchSide& s) {
    return fmt::format("{:<13} {:>9.4g} {:>10.4g}", s.name, s.quality, s.cost);
  };
  fmt::print("{:<12}  {} | {}  {}, {}  {}\n", row.name, side(row.ours), side(row.baseline), row.quality_unit,
             row.cost_unit, row.note);
}

/// For callgrind: drives, and says how many scans the lap has.
int drive_lap(const std::string& world_and_lap) {
  const std::size_t colon = world_and_lap.find(':');
  if (colon == std::string::npos) return report_failure("--measured-lap is WORLD:LAP");
  const Result<std::size_t> scans =
      drive_measured_lap(world_and_lap.substr(0, colon), std::atoi(world_and_lap.c_str() + colon + 1));
  if (!scans) return report_failure(scans.error().message);
  fmt::print("{}\n", *scans);
  return kDone;
}

int run_verb(BenchArguments a) {
  if (!a.measured_lap.empty()) return drive_lap(a.measured_lap);
  if (a.options.data.empty()) a.options.data = find_recorded_data();
  a.options.program = this_program();
  if (!a.json) {
    fmt::print("{:<12}  {:<13} {:>9} {:>10} | {:<13} {:>9} {:>10}\n", "", "ours", "quality", "cost", "baseline",
               "quality", "cost");
  }
  Json rows = Json::array();
  Json skipped = Json::array();
  for (const Benchmark& b : benchmarks(a.options)) {
    if (b.name.find(a.filter) == std::string::npos) continue;
    if (!b.missing.empty()) {
      report_warning(fmt::format("skipped: {}: {}", b.name, b.missing));
      skipped.push_back({{"name", b.name}, {"reason", b.missing}});
      continue;
    }
    const Result<BenchRow> row = b.run();
    if (!row) return report_failure(row.error().message);
    if (!a.json) print_row(*row);
    rows.push_back(to_json(*row));
  }
  if (rows.empty() && skipped.empty()) return report_failure(fmt::format("no benchmark's name holds \"{}\"", a.filter));
  if (a.json) fmt::print("{}\n", Json{{"version", HELICOID_VERSION}, {"rows", rows}, {"skipped", skipped}}.dump(1));
  return kDone;
}

}  // namespace

std::vector<Benchmark> benchmarks(const BenchOptions& options) {
  std::vector<Benchmark> all;
  for (const auto& make : {reading_benchmarks, ray_benchmarks, fit_benchmarks, confidence_benchmarks,
                           mapping_benchmarks, lap_benchmarks}) {
    for (Benchmark& b : make(options)) all.push_back(std::move(b));
  }
  return all;
}

void add_bench_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<BenchArguments>();
  CLI::App* verb = program.add_subcommand("bench", "Measure quality and CPU time, each beside a baseline");
  verb->add_option("--filter", a->filter,
                   "only benchmarks whose name holds this (read, rays, fit, confidence, map, laps, office, ...)");
  verb->add_option("--data", a->options.data, "the folder of recorded data; logs that are not there are skipped");
  verb->add_flag("--large", a->options.large, "also what takes a minute and gigabytes (fit grid 1000000)");
  verb->add_option("--repeats", a->options.repeats, "the least CPU time of so many runs counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  verb->add_option("--measured-lap", a->measured_lap, "WORLD:LAP, for callgrind")->group("");
  verb->add_flag("--json", a->json, "print one JSON object");
  verb->footer(
      "Examples:\n  helicoid bench\n  helicoid bench --filter map\n  helicoid bench --filter laps  (needs valgrind)\n"
      "Quality and cost: smaller is better. Times are CPU times of the thread.");
  verb->callback([a, &exit_code] { exit_code = run_verb(*a); });
}

}  // namespace helicoid
