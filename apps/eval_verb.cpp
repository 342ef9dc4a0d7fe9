// helicoid eval: how good is a trajectory?
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/evaluated_relations.hpp"
#include "apps/verb.hpp"
#include "helicoid/eval/trajectory_error.hpp"
#include "helicoid/io/trajectory.hpp"

namespace helicoid {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct EvalArguments {
  std::vector<std::string> trajectories;
  std::string relations;
  std::string truth;
  double max_gap = 0;
  bool between_robots = false;
  bool json = false;
};

std::string robot_name(const fs::path& path) {
  const std::string file = path.filename().string();
  return file.substr(0, file.find('.'));
}

/// Which island each robot of a map stands on.
std::map<std::string, int> read_islands(const fs::path& folder) {
  std::map<std::string, int> islands;
  std::ifstream file(folder / "summary.json");
  const Json summary = Json::parse(file, nullptr, false);
  if (summary.is_discarded() || !summary.contains("robots")) return islands;
  for (const auto& robot : summary["robots"]) {
    if (robot["island"].is_number()) islands[robot["name"]] = robot["island"];
  }
  return islands;
}

Result<EvaluatedTrajectory> load(const std::string& path, int frame) {
  Result<TumFile> file = read_tum(path);
  if (!file) return tl::unexpected(file.error());
  for (const Skipped& s : file->skipped) {
    report_warning(fmt::format("{} x {}, first at {}", s.count, s.reason, s.first));
  }
  EvaluatedTrajectory trajectory{robot_name(path), frame, {}, {}};
  for (const StampedPose& p : file->poses) {
    trajectory.stamps.push_back(p.stamp);
    trajectory.poses.push_back(p.pose);
  }
  return trajectory;
}

/// Trajectories by name, or those of a map's folder, each in the frame of its island.
Result<std::vector<EvaluatedTrajectory>> load_all(const std::vector<std::string>& names) {
  std::vector<EvaluatedTrajectory> all;
  for (const std::string& name : names) {
    std::error_code error;
    if (!fs::is_directory(name, error)) {
      Result<EvaluatedTrajectory> one = load(name, static_cast<int>(all.size()));
      if (!one) return tl::unexpected(one.error());
      all.push_back(std::move(*one));
      continue;
    }
    const std::map<std::string, int> islands = read_islands(name);
    const fs::path folder =
        fs::is_directory(fs::path(name) / "trajectories", error) ? fs::path(name) / "trajectories" : fs::path(name);
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".tum") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    if (files.empty())
      return fail("{}: holds no trajectory (trajectories/*.tum); name a map's folder or .tum files", name);
    for (const fs::path& file : files) {
      const auto island = islands.find(robot_name(file));
      Result<EvaluatedTrajectory> one =
          load(file.string(), island != islands.end() ? island->second : static_cast<int>(all.size()));
      if (!one) return tl::unexpected(one.error());
      all.push_back(std::move(*one));
    }
  }
  return all;
}

Json to_json(const ErrorStatistics& s) {
  return {{"mean", s.mean}, {"std", s.std}, {"rms", s.rms}, {"max", s.max}};
}

int score_relations(const EvalArguments& a, const std::vector<EvaluatedTrajectory>& trajectories) {
  const Result<RelationsFile> file = read_relations(a.relations);
  if (!file) return report_failure(file.error().message);
  for (const Skipped& s : file->skipped) {
    report_warning(fmt::format("{} x {}, first at {}", s.count, s.reason, s.first));
  }
  RelationErrorOptions options;
  if (a.max_gap > 0) options.max_gap = a.max_gap;
  options.between_robots = a.between_robots;
  const RelationError e = relation_error(trajectories, to_evaluate(*file), options);
  if (a.json) {
    const Json json = {{"relations", e.relations},
                       {"scored", e.scored},
                       {"missing", e.missing},
                       {"translation_m", to_json(e.translation_m)},
                       {"rotation_deg", to_json(e.rotation_deg)}};
    fmt::print("{}\n", json.dump(1));
  } else {
    fmt::print("relations    {} scored, {} missing\n", e.scored, e.missing);
    fmt::print("translation  mean {:.4f} m, std {:.4f}, rms {:.4f}, max {:.4f}\n", e.translation_m.mean,
               e.translation_m.std, e.translation_m.rms, e.translation_m.max);
    fmt::print("rotation     mean {:.3f} deg, std {:.3f}, rms {:.3f}, max {:.3f}\n", e.rotation_deg.mean,
               e.rotation_deg.std, e.rotation_deg.rms, e.rotation_deg.max);
  }
  return e.missing > 0 ? kNotAsAsked : kDone;
}

int score_truth(const EvalArguments& a, const std::vector<EvaluatedTrajectory>& trajectories) {
  if (trajectories.size() != 1) return report_failure("--truth scores one trajectory; name one");
  const Result<EvaluatedTrajectory> truth = load(a.truth, 0);
  if (!truth) return report_failure(truth.error().message);
  const EvaluatedTrajectory& t = trajectories.front();
  const TrajectoryError e = trajectory_error(t.stamps, t.poses, truth->stamps, truth->poses);
  if (a.json) {
    const Json json = {{"poses", t.poses.size()},
                       {"matched", e.matched},
                       {"ate_m", e.ate_m},
                       {"rpe_m", e.rpe_m},
                       {"rpe_deg", e.rpe_deg}};
    fmt::print("{}\n", json.dump(1));
  } else {
    fmt::print("poses  {} of {} with a true pose\nATE    {:.4f} m\nRPE    {:.4f} m, {:.3f} deg over a second\n",
               e.matched, t.poses.size(), e.ate_m, e.rpe_m, e.rpe_deg);
  }
  return e.matched < t.poses.size() ? kNotAsAsked : kDone;
}

int run_verb(const EvalArguments& a) {
  const Result<std::vector<EvaluatedTrajectory>> trajectories = load_all(a.trajectories);
  if (!trajectories) return report_failure(trajectories.error().message);
  return a.relations.empty() ? score_truth(a, *trajectories) : score_relations(a, *trajectories);
}

}  // namespace

void add_eval_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<EvalArguments>();
  CLI::App* verb = program.add_subcommand("eval", "Score trajectories against known relations or a true trajectory");
  verb->add_option("TRAJECTORY", a->trajectories, "TUM trajectories, or the folder of a map")->required();
  auto* relations = verb->add_option("--relations", a->relations, "known relative poses (Kuemmerle et al. 2009)");
  auto* truth = verb->add_option("--truth", a->truth, "a true trajectory (TUM)")->excludes(relations);
  verb->add_option("--max-gap", a->max_gap, "score only relations of scans at most S seconds apart")->needs(relations);
  verb->add_flag("--between-robots", a->between_robots, "score only relations of two robots")->needs(relations);
  verb->add_flag("--json", a->json, "print one JSON object");
  verb->footer(
      "Examples:\n  helicoid eval site --relations intel.relations.gz --max-gap 5\n"
      "  helicoid eval site/trajectories/robot1.tum --truth sim/truth/robot1.tum");
  verb->callback([a, truth, relations, &exit_code] {
    if (truth->empty() && relations->empty()) throw CLI::RequiredError("--relations or --truth");
    exit_code = run_verb(*a);
  });
}

}  // namespace helicoid
