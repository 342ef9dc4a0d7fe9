// Does a team finish when its radio fails for a while, a robot dies and another comes late?
#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/experiments/list.hpp"
#include "apps/explore_quality.hpp"
#include "apps/explore_run.hpp"

namespace helicoid {

namespace {

constexpr std::size_t kRobots = 4;
constexpr std::size_t kDying = 1;
constexpr std::size_t kLate = 3;

/// The same team when a third of the time that it needs undisturbed is without radio.
ExploreJob disturbed(ExploreJob job, double undisturbed_s) {
  job.robots[kDying].dies_at = undisturbed_s / 2;
  job.robots[kLate].joins_at = undisturbed_s / 4;
  RadioOptions radio;
  radio.p_world_base = job.world.starts.front().translation();
  radio.cuts.push_back({undisturbed_s / 3, 2 * undisturbed_s / 3, {}});
  job.radio = radio;
  return job;
}

/// With a robot that will never move again.
World with_body(World world, const Vector2d& p_world, double radius) {
  constexpr int kSides = 24;
  const auto corner = [&](int k) {
    const double angle = 2 * std::numbers::pi * k / kSides;
    return Vector2d(p_world + radius * Vector2d(std::cos(angle), std::sin(angle)));
  };
  for (int k = 0; k < kSides; ++k) world.walls.push_back({corner(k), corner(k + 1)});
  return world;
}

Result<Outcome> cut_off(const std::string& name, std::uint64_t seed) {
  const Result<World> world = load_world(name);
  if (!world) return tl::unexpected(world.error());
  const ExploreJob job = explore_from_starts(*world, kRobots, seed);
  const Result<ExploreRun> plain = run_exploration(job);
  if (!plain) return tl::unexpected(plain.error());
  const ExploreJob job_cut = disturbed(job, plain->sim_s);
  const Result<ExploreRun> run = run_exploration(job_cut);
  if (!run) return tl::unexpected(run.error());
  std::vector<Pose2> living;
  for (std::size_t i = 0; i < kRobots; ++i) {
    if (i != kDying) living.push_back(world->starts[i]);
  }
  const Vector2d p_world_dead = run->recording.tracks()[kDying].T_world_robot.back().translation();
  const Result<BuildingTruth> truth =
      BuildingTruth::of(with_body(*world, p_world_dead, job.simulation.radius), living, job.simulation.radius);
  if (!truth) return tl::unexpected(truth.error());
  const Map& map = run->map.mapper.map();
  const MapQuality quality = truth->judge(map, run->recording.tracks());
  const OrderEffect& order = *run->order;
  const std::size_t taken = run->recording.tracks()[kDying].stamps.size();
  const std::size_t kept = std::min(order.scans_heard[kDying], map.robots()[kDying].trajectory.size());
  return Outcome{{{"mapped_percent", 100 * quality.mapped_fraction},
                  {"explored_count", run->last_plan.end_state == EndState::explored ? 1.0 : 0.0},
                  {"islands_count", static_cast<double>(map.islands().size())},
                  {"dead_robots_scans_count", static_cast<double>(taken)},
                  {"dead_robots_scans_lost_count", static_cast<double>(taken) - static_cast<double>(kept)},
                  {"collisions_count", static_cast<double>(run->contacts.size())},
                  {"same_islands_count", order.same_islands ? 1.0 : 0.0},
                  {"closures_heard_count", static_cast<double>(order.closures_heard)},
                  {"closures_stamped_count", static_cast<double>(order.closures_stamped)},
                  {"closures_apart_m", order.closures_apart_m},
                  {"closures_elsewhere_count", static_cast<double>(order.closures_elsewhere)},
                  {"order_mean_m", order.mean_m},
                  {"order_farthest_m", order.farthest_m},
                  {"order_mean_deg", order.mean_deg},
                  {"order_farthest_deg", order.farthest_deg},
                  {"wall_rms_m", quality.wall_rms_m},
                  {"explored_s", run->sim_s},
                  {"undisturbed_s", plain->sim_s}},
                 {}};
}

}  // namespace

Experiment radio_experiment() {
  Experiment e;
  e.name = "radio";
  e.question = "Does a team finish when its radio fails for a while, a robot dies and another comes late?";
  e.method =
      "The office of experiment fig6, four robots from two doors. First undisturbed, to know how long that takes; then "
      "without radio for the middle third of that time, one robot dead after half of it and one that comes after a "
      "quarter. Without radio each robot explores by itself with a map of its own; afterwards what it has seen arrives "
      "late and in bulk. Mapped: of the floor that the living can reach, whose way the dead one may bar. Lost: scans "
      "that the dead one took and that the map of what was heard or the map of the logs does not have. The events are "
      "mapped twice, as they were heard and by their stamps (as `map` does with the logs): islands, how far the maps "
      "disagree about the places of any closure of either (elsewhere: by more than 0.10 m, and by more than the other "
      "map says itself, 99 %), and how far the poses lie apart after one rigid transform an island.";
  e.bars = {{"mapped_percent", 99.0, std::nullopt, false},
            {"explored_count", 1.0, std::nullopt, false},
            {"dead_robots_scans_lost_count", std::nullopt, 0.0, false},
            {"collisions_count", std::nullopt, 0.0, false},
            {"same_islands_count", 1.0, std::nullopt, false},
            {"closures_elsewhere_count", std::nullopt, 0.0, false},
            {"order_mean_m", std::nullopt, 0.02, false},
            {"order_mean_deg", std::nullopt, 0.2, false}};
  e.seeds = 10;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions& options) {
    const std::string world = options.quick ? "flat" : "office";
    return std::vector<ExperimentCase>{{world, true, "", [world](std::uint64_t seed) { return cut_off(world, seed); }}};
  };
  return e;
}

}  // namespace helicoid
