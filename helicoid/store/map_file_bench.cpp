#include <benchmark/benchmark.h>

#include <filesystem>

#include "helicoid/store/map_file.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

std::string bench_path() {
  return (std::filesystem::temp_directory_path() / "helicoid_bench.gpkg").string();
}

/// A map of the size of a large office: 800 patches, 14 000 scans, 8 000 relations.
Map office() {
  return synthetic::random_map(1, 800, 14000, 8000);
}

void BM_WriteMap(benchmark::State& state) {
  const Map map = office();
  for (auto _ : state) {
    if (!write_map(map, bench_path())) state.SkipWithError("not written");
  }
  state.counters["MB"] = static_cast<double>(std::filesystem::file_size(bench_path())) / 1e6;
  std::filesystem::remove(bench_path());
}
BENCHMARK(BM_WriteMap)->Unit(benchmark::kMillisecond);

void BM_ReadMap(benchmark::State& state) {
  if (!write_map(office(), bench_path())) state.SkipWithError("not written");
  for (auto _ : state) benchmark::DoNotOptimize(read_map(bench_path()));
  std::filesystem::remove(bench_path());
}
BENCHMARK(BM_ReadMap)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace helicoid
