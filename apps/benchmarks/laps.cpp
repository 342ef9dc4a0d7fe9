// Does a scan on known ground cost the same on lap ten as on lap two? Instructions, counted by callgrind.
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "apps/bench.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/io/laser_file.hpp"

namespace helicoid {

namespace {

constexpr int kLaps = 10;

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, decltype(&pclose)> pipe(popen(command.c_str(), "r"), pclose);
  std::string output;
  std::array<char, 256> buffer{};
  while (pipe && std::fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) output += buffer.data();
  return output;
}

/// Instructions a scan of one lap.
Result<double> count_instructions(const BenchOptions& options, const std::string& world, int lap) {
  const auto counts = std::filesystem::temp_directory_path() / fmt::format("helicoid-callgrind-{}-{}", getpid(), lap);
  const std::string scans =
      output_of(fmt::format("valgrind --tool=callgrind --toggle-collect='*measured_step*' --callgrind-out-file={} '{}' "
                            "bench --measured-lap {}:{} 2>/dev/null",
                            counts.string(), options.program, world, lap));
  std::ifstream file(counts);
  std::string word;
  double instructions = 0;
  while (file >> word) {
    if (word == "totals:") file >> instructions;
  }
  std::error_code error;
  std::filesystem::remove(counts, error);
  const double count = std::atof(scans.c_str());
  if (!(count > 0) || !(instructions > 0)) return fail("valgrind counted nothing on lap {} of {}", lap, world);
  return instructions / count;
}

Result<BenchRow> run(const BenchOptions& options, const std::string& world) {
  const Result<double> second = count_instructions(options, world, 2);
  if (!second) return tl::unexpected(second.error());
  const Result<double> last = count_instructions(options, world, kLaps);
  if (!last) return tl::unexpected(last.error());
  BenchRow row;
  row.name = "laps " + world;
  row.quality_unit = "times lap two";
  row.cost_unit = "instructions a scan";
  row.ours = {"lap ten", *last / *second, *last};
  row.baseline = {"lap two", 1, *second};
  row.note = "at most 1.05 times is wanted";
  return row;
}

}  // namespace

/// A name that callgrind can toggle on; out of line, so that it has one.
[[gnu::noinline]] void measured_step(Mapper& mapper, const Event& event) {
  mapper.process(event);
}

Result<std::size_t> drive_measured_lap(const std::string& world_name, int lap) {
  const Result<World> world = load_world(world_name);
  if (!world) return tl::unexpected(world.error());
  SimulationOptions options;
  options.laps = kLaps;
  Result<Simulator> simulator = Simulator::make(*world, options);
  if (!simulator) return tl::unexpected(simulator.error());
  const Result<LaserModel> laser = load_laser("sick-lms200", simulator->laser());
  if (!laser) return tl::unexpected(laser.error());
  Mapper mapper;
  mapper.add_robot(simulated_robot_name(0), {*laser});
  std::size_t scans = 0;
  while (const auto event = simulator->next()) {
    if (event->lap + 1 != lap) {
      mapper.process(event->event);
      continue;
    }
    measured_step(mapper, event->event);
    if (std::holds_alternative<Scan>(event->event.body)) ++scans;
  }
  return scans;
}

std::vector<Benchmark> lap_benchmarks(const BenchOptions& options) {
  const bool there = std::system("command -v valgrind >/dev/null 2>&1") == 0;
  std::vector<Benchmark> all;
  for (const char* world : {"room", "branch"}) {
    all.push_back(
        {std::string("laps ") + world, there ? "" : "valgrind is not installed", [=] { return run(options, world); }});
  }
  return all;
}

}  // namespace helicoid
