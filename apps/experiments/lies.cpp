// Do lies join what does not belong together?
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "apps/corruption.hpp"
#include "apps/evaluated_relations.hpp"
#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/map_run.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/io/carmen_writer.hpp"
#include "helicoid/io/gzip_file.hpp"

namespace helicoid {

namespace {

namespace fs = std::filesystem;

/// A folder for logs that is gone when the case is over.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name)
      : path_(fs::temp_directory_path() / fmt::format("helicoid-{}-{}", name, getpid())) {
    fs::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

/// Logs of a team and what is truly known of it.
struct TrueTeam {
  std::vector<RobotLogs> robots;
  std::vector<EvaluatedRelation> relations;
  std::size_t sightings = 0;
  bool is_simulated = false;
};

Result<TrueTeam> recorded_team(const std::string& folder, std::size_t robots) {
  TrueTeam team;
  for (std::size_t i = 1; i <= robots; ++i) {
    const std::string name = fmt::format("robot{}", i);
    team.robots.push_back({name, {fmt::format("{}/{}.clf.gz", folder, name)}});
  }
  Result<std::vector<EvaluatedRelation>> relations = read_evaluated(folder + "/team.relations.gz");
  if (!relations) return tl::unexpected(relations.error());
  team.relations = std::move(*relations);
  team.sightings = robots - 1;
  return team;
}

/// Three robots in an office, some coming towards the others, as the simulator writes them.
Result<TrueTeam> simulated_team(std::uint64_t seed, const std::string& folder) {
  const Result<World> world = load_world("office");
  if (!world) return tl::unexpected(world.error());
  SimulationOptions options;
  options.robots = 3;
  options.seed = seed;
  options.alternate = true;
  options.sightings = true;
  Result<Simulator> simulator = Simulator::make(*world, options);
  if (!simulator) return tl::unexpected(simulator.error());
  TrueTeam team;
  team.is_simulated = true;
  std::vector<std::string> logs(3);
  std::vector<TrueTrack> tracks;
  for (std::size_t i = 0; i < 3; ++i) tracks.push_back({simulated_robot_name(i), {}, {}});
  while (const std::optional<SimulatedEvent> simulated = simulator->next()) {
    const std::size_t robot = simulated->event.robot.index();
    append_carmen(logs[robot], simulated->event, "simulation");
    team.sightings += std::holds_alternative<Sighting>(simulated->event.body) ? 1 : 0;
    if (!std::holds_alternative<Scan>(simulated->event.body)) continue;
    tracks[robot].stamps.push_back(simulated->event.stamp);
    tracks[robot].T_world_robot.push_back(simulated->T_world_robot);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string path = fmt::format("{}/{}.clf.gz", folder, tracks[i].robot);
    if (auto done = write_gzip_file(path, logs[i]); !done) return tl::unexpected(done.error());
    team.robots.push_back({tracks[i].robot, {path}});
  }
  team.relations = true_relations(tracks, seed);
  return team;
}

/// What became of the sightings and the reported look-alikes.
struct Believed {
  double true_accepted = 0, true_left = 0, lies_accepted = 0, lies = 0;
};
Believed count_believed(const Mapper& mapper, const Corruption& corruption) {
  std::set<std::pair<std::string, long>> lies;
  const auto key = [](const std::string& robot, double stamp) { return std::pair(robot, std::lround(1e5 * stamp)); };
  for (const Lie& lie : corruption.lies) {
    if (lie.line.starts_with("SIGHTING")) lies.insert(key(lie.robot, lie.stamp));
  }
  Believed b;
  for (const Hypothesis& h : mapper.ledger()) {
    if (!h.seen) continue;
    const bool lie = lies.contains(key(mapper.map().robot(h.seen->observer).name, h.seen->stamp));
    const bool accepted = h.state == HypothesisState::accepted;
    (lie ? (accepted ? b.lies_accepted : b.lies) : (accepted ? b.true_accepted : b.true_left)) += 1;
  }
  return b;
}

/// A wrong join shows between robots: some relation of the truth is off by metres.
constexpr double kWrong = 1.0;

Result<Outcome> lie_to(const TrueTeam& team, double lies_per_truth, std::uint64_t seed, const std::string& folder) {
  CorruptionOptions options;
  const double truths = static_cast<double>(team.sightings);
  options.false_sightings = static_cast<std::size_t>(std::lround(lies_per_truth * truths));
  options.false_lookalikes = options.false_sightings;
  options.unidentified = 0.5;
  options.seed = seed;
  const std::string lied = folder + "/lied";
  fs::create_directories(lied);
  const Result<Corruption> corruption = corrupt_logs(team.robots, options, lied);
  if (!corruption) return tl::unexpected(corruption.error());
  MapJob job;
  job.robots = corruption->robots;
  const double began = thread_cpu_seconds();
  const Result<MapRun> run = run_map(job);
  if (!run) return tl::unexpected(run.error());
  const double cpu_s = thread_cpu_seconds() - began;
  const Map& map = run->mapper.map();
  RelationErrorOptions between;
  between.between_robots = true;
  const RelationError error = relation_error(final_trajectories(map), team.relations, between);
  const Believed b = count_believed(run->mapper, *corruption);
  const double accepted = b.true_accepted + b.lies_accepted;
  const double recall = 100 * b.true_accepted / std::max(1.0, b.true_accepted + b.true_left);
  Outcome outcome{{{"wrong_joins_count", error.scored > 0 && error.translation_m.max > kWrong ? 1.0 : 0.0},
                   {"islands_count", static_cast<double>(map.islands().size())},
                   {"between_robots_mean_m", error.scored > 0 ? error.translation_m.mean : 0},
                   {"recall_percent", recall},
                   {"precision_percent", accepted > 0 ? 100 * b.true_accepted / accepted : 100},
                   {"true_sightings_count", b.true_accepted + b.true_left},
                   {"false_sightings_count", b.lies_accepted + b.lies},
                   {"false_sightings_accepted_count", b.lies_accepted},
                   {"passes_count", static_cast<double>(run->passes)},
                   {"cpu_s", cpu_s}},
                  {}};
  if (team.is_simulated) outcome.metrics.push_back({"team_recall_percent", recall});
  return outcome;
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  struct Recorded {
    const char* name;
    std::size_t robots;
  };
  std::vector<ExperimentCase> cases;
  for (const int percent : {50, 100, 200}) {
    if (options.quick && percent != 100) continue;
    const double share = percent / 100.0;
    for (const Recorded& r : {Recorded{"intel3", 3}, Recorded{"fr079x2", 2}}) {
      const std::string folder = fmt::format("{}/teams/{}", options.data, r.name);
      cases.push_back({fmt::format("{}-{}", r.name, percent), true,
                       missing_data(options, fmt::format("teams/{}", r.name)),
                       [=, robots = r.robots](std::uint64_t seed) -> Result<Outcome> {
                         const ScratchFolder scratch(fmt::format("lies-{}-{}-{}", robots, percent, seed));
                         const Result<TrueTeam> team = recorded_team(folder, robots);
                         if (!team) return tl::unexpected(team.error());
                         return lie_to(*team, share, seed, scratch.path());
                       }});
    }
    cases.push_back({fmt::format("office3-{}", percent), true, "", [=](std::uint64_t seed) -> Result<Outcome> {
                       const ScratchFolder scratch(fmt::format("lies-office-{}-{}", percent, seed));
                       const Result<TrueTeam> team = simulated_team(seed, scratch.path());
                       if (!team) return tl::unexpected(team.error());
                       return lie_to(*team, share, seed, scratch.path());
                     }});
  }
  return cases;
}

}  // namespace

Experiment lies_experiment() {
  Experiment e;
  e.name = "lies";
  e.question = "Do lies join what does not belong together?";
  e.method =
      "Two recorded logs that were cut into teams, with one true sighting a robot to be joined, and three simulated "
      "robots that see each other often; to each are added false sightings and as many false look-alikes, half, as "
      "many "
      "and twice as many as there are true sightings, half of the false sightings without a name, all as sure of "
      "themselves as the truth (helicoid corrupt). A wrong join: a known relation between robots is off by more than a "
      "metre in the final map. Precision and recall are of sightings that are accepted in the end.";
  e.bars = {{"wrong_joins_count", std::nullopt, 0.0, false}, {"team_recall_percent", 95.0, std::nullopt, true}};
  e.seeds = 10;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
