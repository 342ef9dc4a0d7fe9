// Ray casting through a grid, against trying every wall.
#include <cmath>

#include "apps/bench.hpp"
#include "helicoid/base/random.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

namespace {

struct Ray {
  Vector2d from, direction;
};

std::vector<Ray> random_rays(const World& world, std::size_t count) {
  Random random(1);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2d& from = world.routes[0].points[random.below(world.routes[0].points.size())];
    const double angle = random.uniform(-std::numbers::pi, std::numbers::pi);
    rays.push_back({from, {std::cos(angle), std::sin(angle)}});
  }
  return rays;
}

Result<BenchRow> run(const BenchOptions& options) {
  constexpr double kReach = 80;
  const Result<World> world = load_world("office");
  if (!world) return tl::unexpected(world.error());
  const RayCaster caster(world->walls);
  const std::vector<Ray> rays = random_rays(*world, 100'000);
  std::vector<double> ours(rays.size());
  std::vector<double> every(rays.size());
  const double our_seconds = least_cpu_seconds(options.repeats, [&] {
    for (std::size_t i = 0; i < rays.size(); ++i)
      ours[i] = caster.cast(rays[i].from, rays[i].direction, kReach).distance;
  });
  const double every_seconds = least_cpu_seconds(options.repeats, [&] {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      every[i] = INFINITY;
      for (const Segment& s : world->walls)
        every[i] = std::min(every[i], intersect(rays[i].from, rays[i].direction, s));
    }
  });
  double difference = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) difference = std::max(difference, std::abs(ours[i] - every[i]));
  const auto count = static_cast<double>(rays.size());
  BenchRow row;
  row.name = "rays office";
  row.quality_unit = "m of difference";
  row.cost_unit = "us a ray";
  row.ours = {"RayCaster", difference, 1e6 * our_seconds / count};
  row.baseline = {"every wall", 0, 1e6 * every_seconds / count};
  row.note = fmt::format("{} walls", world->walls.size());
  return row;
}

}  // namespace

std::vector<Benchmark> ray_benchmarks(const BenchOptions& options) {
  return {{"rays office", "", [options] { return run(options); }}};
}

}  // namespace helicoid
