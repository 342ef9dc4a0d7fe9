// Reading logs, against the standard library's streams.
#include <cmath>
#include <sstream>

#include "apps/bench.hpp"
#include "helicoid/io/carmen_reader.hpp"
#include "helicoid/io/carmen_writer.hpp"
#include "helicoid/simulation/simulator.hpp"

namespace helicoid {

namespace {

/// Scans that a log holds, and the sum of their ranges: two readers agree if both agree.
struct Contents {
  std::size_t scans = 0;
  double ranges = 0;
};

Contents read_ours(const std::string& log) {
  std::vector<TextFile> files{{"log", log, ""}};
  CarmenReader reader(std::move(files), make_id<RobotId>(0));
  Contents contents;
  while (const Event* event = reader.next()) {
    const auto* scan = std::get_if<Scan>(&event->body);
    if (scan == nullptr) continue;
    ++contents.scans;
    for (const float r : scan->ranges) contents.ranges += static_cast<double>(r);
  }
  return contents;
}

Contents read_streams(const std::string& log) {
  std::istringstream lines(log);
  std::string line;
  Contents contents;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string kind;
    std::size_t count = 0;
    if (!(words >> kind >> count) || kind != "FLASER") continue;
    ++contents.scans;
    float range = 0;
    for (std::size_t i = 0; i < count && words >> range; ++i) contents.ranges += static_cast<double>(range);
  }
  return contents;
}

Result<BenchRow> run(const BenchOptions& options) {
  const Result<World> world = load_world("office");
  if (!world) return tl::unexpected(world.error());
  Result<Simulator> simulator = Simulator::make(*world, {});
  if (!simulator) return tl::unexpected(simulator.error());
  std::string log;
  while (const auto event = simulator->next()) append_carmen(log, event->event, "bench");
  Contents ours;
  Contents streams;
  const double our_seconds = least_cpu_seconds(options.repeats, [&] { ours = read_ours(log); });
  const double stream_seconds = least_cpu_seconds(options.repeats, [&] { streams = read_streams(log); });
  const auto scans = static_cast<double>(ours.scans);
  BenchRow row;
  row.name = "read office";
  row.quality_unit = "m of difference";
  row.cost_unit = "us a scan";
  row.ours = {"CarmenReader", std::abs(ours.ranges - streams.ranges), 1e6 * our_seconds / scans};
  row.baseline = {"std::istream", 0, 1e6 * stream_seconds / scans};
  row.note = fmt::format("{:.0f} MB/s", 1e-6 * static_cast<double>(log.size()) / our_seconds);
  return row;
}

}  // namespace

std::vector<Benchmark> reading_benchmarks(const BenchOptions& options) {
  return {{"read office", "", [options] { return run(options); }}};
}

}  // namespace helicoid
