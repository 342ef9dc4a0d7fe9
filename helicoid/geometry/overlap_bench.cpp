// How much do two patches' free space overlap? Exactly, by polysolids; or on a 10 cm raster, by row spans.
#include <benchmark/benchmark.h>

#include "helicoid/base/random.hpp"
#include "helicoid/geometry/polysolid.hpp"
#include "helicoid/geometry/row_spans.hpp"

namespace helicoid {
namespace {

constexpr double kCell = 0.1;

struct Pair {
  std::vector<Eigen::Vector2f> a, b;
  Pose2 T_a_b;
};

/// Free space as 180 beams of a room of some 8 m with things in it see it.
std::vector<Eigen::Vector2f> free_space(Random& random) {
  std::vector<Eigen::Vector2f> ring{{0, 0}};
  double radius = random.uniform(1, 8);
  for (int beam = 0; beam < 180; ++beam) {
    if (random.chance(0.1)) radius = random.uniform(1, 8);
    const double angle = std::numbers::pi * (beam / 180.0 - 0.5);
    ring.push_back(Vector2d(radius * std::cos(angle), radius * std::sin(angle)).cast<float>());
  }
  return ring;
}

std::vector<Pair> make_pairs() {
  Random random(1);
  std::vector<Pair> pairs;
  for (int i = 0; i < 64; ++i) {
    pairs.push_back({free_space(random),
                     free_space(random),
                     {random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-3, 3)}});
  }
  return pairs;
}

Polysolid solid_of(const std::vector<Eigen::Vector2f>& ring, const Pose2& T) {
  Ring exact;
  for (const Eigen::Vector2f& p : ring) exact.push_back(T * p.cast<double>());
  return make_polysolid(exact);
}

double exact_overlap(const Pair& pair) {
  return area(intersection(solid_of(pair.a, {}), solid_of(pair.b, pair.T_a_b)));
}

double raster_overlap(const Pair& pair) {
  return kCell * kCell *
         static_cast<double>(shared_cells(row_spans(pair.a, {}, kCell), row_spans(pair.b, pair.T_a_b, kCell)));
}

void measure(benchmark::State& state, double (*overlap)(const Pair&)) {
  const std::vector<Pair> pairs = make_pairs();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(overlap(pairs[i++ % pairs.size()]));
  double error = 0;
  double sum = 0;
  for (const Pair& pair : pairs) {
    error += std::abs(overlap(pair) - exact_overlap(pair));
    sum += exact_overlap(pair);
  }
  state.counters["error_%"] = 100 * error / sum;
}

void OverlapByPolysolids(benchmark::State& state) {
  measure(state, exact_overlap);
}
BENCHMARK(OverlapByPolysolids);

void OverlapByRowSpans(benchmark::State& state) {
  measure(state, raster_overlap);
}
BENCHMARK(OverlapByRowSpans);

}  // namespace
}  // namespace helicoid
