// Do robots that start anywhere end on one map, as good as one robot's?
#include <cmath>

#include "apps/evaluated_relations.hpp"
#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/map_run.hpp"
#include "apps/simulated_run.hpp"

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

Result<Scored> map_and_score(std::vector<RobotLogs> robots, std::span<const EvaluatedRelation> relations,
                             bool sightings, std::span<const std::string> names) {
  MapJob job;
  job.robots = std::move(robots);
  job.sightings = sightings;
  job.mapper.join_on_evidence = !sightings;
  const double began = thread_cpu_seconds();
  const Result<MapRun> run = run_map(job);
  if (!run) return tl::unexpected(run.error());
  const double cpu_s = thread_cpu_seconds() - began;
  const Map& map = run->mapper.map();
  std::vector<EvaluatedTrajectory> trajectories = final_trajectories(map);
  if (trajectories.size() == 1) {
    // The one robot drove the ways of all: the same relations are asked of it.
    trajectories.resize(names.size(), trajectories.front());
    for (std::size_t i = 0; i < names.size(); ++i) trajectories[i].robot = names[i];
  }
  RelationErrorOptions between;
  between.between_robots = true;
  return Scored{relation_error(trajectories, relations), relation_error(trajectories, relations, between),
                map.islands().size(), cpu_s};
}

/// The team's relations by the whole log's clock: the cut shifted some robots' stamps, but kept the order and the
/// poses.
std::vector<EvaluatedRelation> by_whole_clock(std::vector<EvaluatedRelation> team,
                                              std::span<const EvaluatedRelation> whole) {
  std::size_t at = 0;
  for (EvaluatedRelation& relation : team) {
    while (at < whole.size() && whole[at].T_a_b != relation.T_a_b) ++at;
    // One that is not there has no stamp, and counts as missing.
    relation.stamp_a = at < whole.size() ? whole[at].stamp_a : HUGE_VAL;
    relation.stamp_b = at < whole.size() ? whole[at].stamp_b : HUGE_VAL;
    ++at;
  }
  return team;
}

Result<Outcome> run_team(const Team& team, const std::string& data, bool sightings) {
  const std::string folder = fmt::format("{}/teams/{}", data, team.name);
  std::vector<RobotLogs> robots;
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= team.robots; ++i) {
    names.push_back(fmt::format("robot{}", i));
    robots.push_back({names.back(), {fmt::format("{}/{}.clf.gz", folder, names.back())}});
  }
  const Result<std::vector<EvaluatedRelation>> relations = read_evaluated(folder + "/team.relations.gz");
  if (!relations) return tl::unexpected(relations.error());
  const std::string whole = fmt::format("{}/{}/{}", data, team.whole, team.whole);
  const Result<std::vector<EvaluatedRelation>> of_whole = read_evaluated(whole + ".relations.gz");
  if (!of_whole) return tl::unexpected(of_whole.error());
  const Result<Scored> joined = map_and_score(robots, *relations, sightings, names);
  if (!joined) return tl::unexpected(joined.error());
  const Result<Scored> single =
      map_and_score({{team.whole, {whole + ".clf.gz"}}}, by_whole_clock(*relations, *of_whole), true, names);
  if (!single) return tl::unexpected(single.error());
  const auto mean = [](const RelationError& error) { return error.translation_m.mean; };
  return Outcome{{{"islands_count", static_cast<double>(joined->islands)},
                  {"missing_relations_count", static_cast<double>(joined->all.missing)},
                  {"single_missing_relations_count", static_cast<double>(single->all.missing)},
                  {"single_mean_m", mean(single->all)},
                  {"single_between_robots_mean_m", mean(single->between)},
                  {"all_mean_m", mean(joined->all)},
                  {"between_robots_mean_m", mean(joined->between)},
                  {"all_ratio", mean(joined->all) / mean(single->all)},
                  {"between_robots_ratio", mean(joined->between) / mean(single->between)},
                  {"cpu_s", joined->cpu_s}},
                 {}};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  for (const Team& team : kTeams) {
    for (const bool sightings : {true, false}) {
      cases.push_back({fmt::format("{}-{}", team.name, sightings ? "sightings" : "evidence"), false,
                       missing_data(options, fmt::format("teams/{}", team.name)),
                       [=, data = options.data](std::uint64_t) { return run_team(team, data, sightings); }});
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
      "and of those between robots alone, over that of the same relations in the whole log mapped as one robot's.";
  e.bars = {{"islands_count", std::nullopt, 1.0, false},
            {"missing_relations_count", std::nullopt, 0.0, false},
            {"single_missing_relations_count", std::nullopt, 0.0, false},
            {"all_ratio", std::nullopt, 1.1, false},
            {"between_robots_ratio", std::nullopt, 1.1, false}};
  e.seeds = 1;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
