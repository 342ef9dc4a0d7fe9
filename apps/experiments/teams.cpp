// Do robots that start anywhere end on one map, as good as one robot's?
#include <filesystem>

#include "apps/experiments/list.hpp"
#include "apps/map_run.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/io/relations_file.hpp"

namespace helicoid {

namespace {

/// A log that was cut into several robots' logs, and the same whole.
struct Team {
  const char* name;
  const char* whole;
  std::size_t robots;
};
constexpr Team kTeams[] = {{"intel3", "intel", 3}, {"fr079x2", "fr079", 2}};

struct Scored {
  RelationError all;
  RelationError between;
  std::size_t islands = 0;
  double cpu_s = 0;
};

Result<Scored> map_and_score(std::vector<RobotLogs> robots, const std::string& relations_path, bool sightings) {
  MapJob job;
  job.robots = std::move(robots);
  job.sightings = sightings;
  job.mapper.join_on_evidence = !sightings;
  const double began = thread_cpu_seconds();
  const Result<MapRun> run = run_map(job);
  if (!run) return tl::unexpected(run.error());
  const double cpu_s = thread_cpu_seconds() - began;
  const Result<RelationsFile> truth = read_relations(relations_path);
  if (!truth) return tl::unexpected(truth.error());
  std::vector<EvaluatedRelation> relations;
  for (const TrueRelation& r : truth->relations) {
    relations.push_back({r.robot_a, r.stamp_a, r.robot_b, r.stamp_b, r.T_a_b});
  }
  const Map& map = run->mapper.map();
  const std::vector<EvaluatedTrajectory> trajectories = final_trajectories(map);
  RelationErrorOptions between;
  between.between_robots = true;
  return Scored{relation_error(trajectories, relations), relation_error(trajectories, relations, between),
                map.islands().size(), cpu_s};
}

Result<Outcome> run_team(const Team& team, const std::string& data, bool sightings) {
  const std::string folder = fmt::format("{}/teams/{}", data, team.name);
  std::vector<RobotLogs> robots;
  for (std::size_t i = 1; i <= team.robots; ++i) {
    robots.push_back({fmt::format("robot{}", i), {fmt::format("{}/robot{}.clf.gz", folder, i)}});
  }
  const Result<Scored> joined = map_and_score(robots, folder + "/team.relations.gz", sightings);
  if (!joined) return tl::unexpected(joined.error());
  const std::string whole = fmt::format("{}/{}/{}", data, team.whole, team.whole);
  const Result<Scored> single = map_and_score({{team.whole, {whole + ".clf.gz"}}}, whole + ".relations.gz", true);
  if (!single) return tl::unexpected(single.error());
  const double base = single->all.translation_m.mean;
  return Outcome{{{"islands_count", static_cast<double>(joined->islands)},
                  {"missing_relations_count", static_cast<double>(joined->all.missing)},
                  {"single_mean_m", base},
                  {"all_mean_m", joined->all.translation_m.mean},
                  {"between_robots_mean_m", joined->between.translation_m.mean},
                  {"all_ratio", joined->all.translation_m.mean / base},
                  {"between_robots_ratio", joined->between.translation_m.mean / base},
                  {"cpu_s", joined->cpu_s}},
                 {}};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  for (const Team& team : kTeams) {
    for (const bool sightings : {true, false}) {
      ExperimentCase c{fmt::format("{}-{}", team.name, sightings ? "sightings" : "evidence"), false, "",
                       [=, data = options.data](std::uint64_t) { return run_team(team, data, sightings); }};
      std::error_code error;
      if (options.data.empty() || !std::filesystem::exists(options.data + "/teams/" + team.name, error)) {
        c.missing =
            fmt::format("the recorded team {} is not there; --data names the folder that holds teams/", team.name);
      }
      cases.push_back(std::move(c));
    }
  }
  return cases;
}

}  // namespace

Experiment teams_experiment() {
  Experiment e;
  e.name = "teams";
  e.question = "Do robots that start anywhere end on one map, as good as one robot's?";
  e.method =
      "Recorded logs that were cut into several robots' logs, each with an unknown start: once with the one sighting a "
      "robot that they hold, once without any and with --join evidence. The mean error of the known relations, of all "
      "and of those between robots alone, beside that of the whole log mapped as one robot's.";
  e.bars = {{"islands_count", std::nullopt, 1.0, false},
            {"missing_relations_count", std::nullopt, 0.0, false},
            {"all_ratio", std::nullopt, 1.1, false},
            {"between_robots_ratio", std::nullopt, 1.1, false}};
  e.seeds = 1;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
