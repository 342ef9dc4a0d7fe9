// What does a team gain by deciding together where each of its robots goes?
#include <algorithm>

#include "apps/experiments/drawn_floors.hpp"
#include "apps/experiments/list.hpp"
#include "apps/explore_run.hpp"
#include "helicoid/simulation/reachable_floor.hpp"
#include "helicoid/simulation/starts.hpp"

namespace helicoid {

namespace {

constexpr double kShare = 0.95;
constexpr double kCell = 0.10;     // of the raster on which coverage is counted, metres
constexpr double kLongest = 1800;  // simulated seconds

/// How much of a floor the scans that were kept have seen, by where the robots truly were.
class SeenFloor {
 public:
  explicit SeenFloor(std::vector<Vector2d> floor)
      : left_(std::move(floor)), enough_(static_cast<std::size_t>((1 - kShare) * static_cast<double>(left_.size()))) {}

  /// Looks at the patches that are new since the last time.
  void update(const Map& map, const std::vector<TrueTrack>& tracks) {
    for (; patches_ < map.patch_count() && !is_seen(); ++patches_) {
      const Patch& patch = map.patch(make_id<PatchId>(patches_));
      strike_out(patch, tracks[patch.robot.index()].T_world_robot[patch.scan_index].inverse());
      if (left_.size() <= enough_) seen_at_ = patch.stamp - LiveSimulation::kFirstStamp;
    }
  }

  [[nodiscard]] bool is_seen() const { return seen_at_ < kLongest; }
  [[nodiscard]] double seen_at() const { return seen_at_; }  ///< seconds; the longest time if it never was

 private:
  void strike_out(const Patch& patch, const Pose2& T_patch_world) {
    const Matrix2d R = T_patch_world.rotation();
    const double reach = patch.free_reach * patch.free_reach;
    std::erase_if(left_, [&](const Vector2d& p_world) {
      const Vector2d p_patch = R * p_world + T_patch_world.translation();
      return p_patch.squaredNorm() <= reach && is_ground(patch, p_patch);
    });
  }

  std::vector<Vector2d> left_;
  std::size_t enough_;
  std::size_t patches_ = 0;
  double seen_at_ = kLongest;
};

struct Building {
  World world;
  std::vector<Pose2> starts;
  std::vector<Vector2d> floor;
};

Result<Building> prepare(Result<World> world, std::size_t robots, std::uint64_t seed) {
  if (!world) return tl::unexpected(world.error());
  StartOptions options;
  options.robots = robots;
  options.seed = seed;
  Result<std::vector<Pose2>> starts = choose_starts(*world, "auto", options);
  if (!starts) return tl::unexpected(starts.error());
  FloorOptions raster;
  raster.cell = kCell;
  const Result<ReachableFloor> floor = find_reachable_floor(*world, *starts, raster);
  if (!floor) return tl::unexpected(floor.error());
  return Building{std::move(*world), std::move(*starts), floor->swept_centres()};
}

struct Cover {
  double seconds = 0;  ///< until the team has seen 95 % of what it can reach; the longest time if it never did
  std::size_t collisions = 0;
};

/// A run that ends as soon as the team has seen so much.
Result<Cover> cover(const Building& building, std::uint64_t seed, bool coordinated) {
  ExploreJob job;
  job.world = building.world;
  for (const Pose2& start : building.starts) job.robots.push_back({start});
  job.simulation.seed = seed;
  job.pilot.explorer.coordinated = coordinated;
  job.longest = kLongest;
  SeenFloor floor(building.floor);
  job.observer = [&](double, const LiveSimulation&, const TeamPilot& pilot, const SimulatedRecording& recording) {
    floor.update(pilot.map(), recording.tracks());
    return !floor.is_seen();
  };
  const Result<ExploreRun> run = run_exploration(job);
  if (!run) return tl::unexpected(run.error());
  return Cover{floor.seen_at(), run->contacts.size()};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

Result<World> world_named(const std::string& name) {
  if (name == "school") return drawn_school();
  if (name == "store") return drawn_store();
  return load_world(name);
}

Result<Outcome> compare(const std::vector<std::string>& worlds, std::size_t robots, std::uint64_t seed) {
  Outcome outcome;
  std::vector<double> sooner;
  std::size_t collisions = 0;
  for (const std::string& name : worlds) {
    const Result<Building> building = prepare(world_named(name), robots, seed);
    if (!building) return tl::unexpected(building.error());
    const Result<Cover> together = cover(*building, seed, true);
    if (!together) return tl::unexpected(together.error());
    const Result<Cover> alone = cover(*building, seed, false);
    if (!alone) return tl::unexpected(alone.error());
    sooner.push_back(100 * (1 - together->seconds / alone->seconds));
    collisions += together->collisions + alone->collisions;
    outcome.metrics.push_back({name + "_together_s", together->seconds});
    outcome.metrics.push_back({name + "_nearest_s", alone->seconds});
    // A bar is asked of four robots alone.
    outcome.metrics.push_back({name + (robots == 4 ? "_four_sooner_percent" : "_sooner_percent"), sooner.back()});
  }
  outcome.metrics.push_back({robots == 4 ? "median_four_sooner_percent" : "median_sooner_percent", median(sooner)});
  outcome.metrics.push_back({"collisions_count", static_cast<double>(collisions)});
  return outcome;
}

}  // namespace

Experiment team_gain_experiment() {
  Experiment e;
  e.name = "team-gain";
  e.question = "What does a team gain by deciding together where each of its robots goes?";
  e.method =
      "Teams of one, two, four and eight robots explore every shipped world and two occupancy images, in two groups "
      "that begin far from each other. Together: as `helicoid explore` assigns frontiers to robots. Nearest: each "
      "robot goes to its nearest frontier on the same shared map, whatever the others do; all else is the same. "
      "Counted is the simulated time until the scans that were kept had seen 95 % of the floor that a robot can reach, "
      "by where the robots truly were.";
  std::vector<std::string> worlds = shipped_worlds();
  worlds.insert(worlds.end(), {"school", "store"});
  e.bars = {{"median_four_sooner_percent", 20.0, std::nullopt, true}, {"collisions_count", std::nullopt, 0.0, false}};
  for (const std::string& name : worlds) e.bars.push_back({name + "_four_sooner_percent", -5.0, std::nullopt, true});
  e.seeds = 10;
  e.quick_seeds = 1;
  e.cases = [worlds](const ExperimentOptions& options) {
    std::vector<ExperimentCase> cases;
    if (options.quick) {
      cases.push_back({"4 robots", true, "", [](std::uint64_t seed) {
                         return compare({"corridor", "hall", "wings"}, 4, seed);
                       }});
      return cases;
    }
    for (const std::size_t robots : {1U, 2U, 4U, 8U}) {
      cases.push_back({fmt::format("{} robot{}", robots, robots == 1 ? "" : "s"), true, "",
                       [worlds, robots](std::uint64_t seed) { return compare(worlds, robots, seed); }});
    }
    return cases;
  };
  return e;
}

}  // namespace helicoid
