// Benchmarks: quality beside time, each against a baseline that is measured in the same run.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "apps/map_run.hpp"
#include "helicoid/base/result.hpp"

namespace helicoid {

struct BenchOptions {
  std::string data;     ///< the folder of recorded data; empty: there is none
  std::string program;  ///< the path of this program, for measurements in a process of their own
  bool large = false;   ///< also what takes a minute and gigabytes
  int repeats = 3;      ///< the least CPU time of so many runs counts
};

/// What was measured of one way of doing it.
struct BenchSide {
  std::string name;
  double quality = 0;
  double cost = 0;
};

struct BenchRow {
  std::string name;
  std::string quality_unit;  ///< "m of error", smaller is better
  std::string cost_unit;     ///< "us a scan"
  BenchSide ours;
  BenchSide baseline;
  std::string note;
};

struct Benchmark {
  std::string name;
  std::string missing;  ///< why it cannot be run here; it is skipped aloud. Empty: it can
  std::function<Result<BenchRow>()> run;
};

/// All benchmarks of this machine, in the order of the table.
[[nodiscard]] std::vector<Benchmark> benchmarks(const BenchOptions& options);

[[nodiscard]] std::vector<Benchmark> reading_benchmarks(const BenchOptions& options);
[[nodiscard]] std::vector<Benchmark> ray_benchmarks(const BenchOptions& options);
/// Needs the judges, built beside the program where Ceres and CHOLMOD are installed.
[[nodiscard]] std::vector<Benchmark> fit_benchmarks(const BenchOptions& options);
[[nodiscard]] std::vector<Benchmark> confidence_benchmarks(const BenchOptions& options);
[[nodiscard]] std::vector<Benchmark> mapping_benchmarks(const BenchOptions& options);
/// Instructions a scan on lap ten against lap two, counted by valgrind's callgrind.
[[nodiscard]] std::vector<Benchmark> lap_benchmarks(const BenchOptions& options);

/// Drives ten laps through a shipped world and maps them; the steps of one lap (1 to 10) run inside a function that
/// callgrind can tell from the rest. Returns how many scans that lap has.
[[nodiscard]] Result<std::size_t> drive_measured_lap(const std::string& world, int lap);

/// The least thread CPU time of several calls, seconds.
template <class Work>
[[nodiscard]] double least_cpu_seconds(int repeats, Work&& work) {
  double least = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const double before = thread_cpu_seconds();
    work();
    least = std::min(least, thread_cpu_seconds() - before);
  }
  return least;
}

}  // namespace helicoid
