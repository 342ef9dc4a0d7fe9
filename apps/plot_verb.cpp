// helicoid plot: what a map's folder says, as charts.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/chart.hpp"
#include "apps/output_folder.hpp"
#include "apps/verb.hpp"
#include "helicoid/base/whole_file.hpp"
#include "helicoid/eval/trajectory_error.hpp"
#include "helicoid/io/trajectory.hpp"
#include "helicoid/store/map_file.hpp"

namespace helicoid {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct PlotArguments {
  std::string folder;
  std::string out;
  std::string truth;
  bool force = false;
  bool json = false;
};

struct NamedTrajectory {
  std::string robot;
  std::vector<StampedPose> poses;
};

Result<std::vector<NamedTrajectory>> read_folder(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".tum") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) return fail("{}: holds no trajectory (*.tum)", folder.string());
  std::vector<NamedTrajectory> all;
  for (const fs::path& file : files) {
    Result<TumFile> tum = read_tum(file.string());
    if (!tum) return tl::unexpected(tum.error());
    all.push_back({file.stem().string(), std::move(tum->poses)});
  }
  return all;
}

std::vector<Vector2d> places(std::span<const StampedPose> poses, const Pose2& T_to_from) {
  std::vector<Vector2d> points;
  for (const StampedPose& p : poses) points.push_back(T_to_from * p.pose.translation());
  return points;
}

/// The truth's poses at the stamps of a trajectory, as pairs of points.
struct Matched {
  std::vector<Vector2d> estimated, truth;
  std::vector<double> stamps;
};
Matched match(const NamedTrajectory& estimated, const NamedTrajectory& truth) {
  Matched pairs;
  for (const StampedPose& p : estimated.poses) {
    const auto at = std::lower_bound(truth.poses.begin(), truth.poses.end(), p.stamp - 1e-3,
                                     [](const StampedPose& t, double stamp) { return t.stamp < stamp; });
    if (at == truth.poses.end() || at->stamp > p.stamp + 1e-3) continue;
    pairs.estimated.push_back(p.pose.translation());
    pairs.truth.push_back(at->pose.translation());
    pairs.stamps.push_back(p.stamp);
  }
  return pairs;
}

/// The trajectories, and how far they are from the truth where it is known.
std::vector<Chart> trajectory_charts(const std::vector<NamedTrajectory>& robots,
                                     const std::vector<NamedTrajectory>& truths) {
  Chart map{"Where the robots went", "x [m]", "y [m]", {}, {}, true, {}, 900, 700};
  Chart error{"Distance from the truth after one rigid alignment", "time [s]", "error [m]", {}, {}, false, 0.0};
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const auto truth = std::find_if(truths.begin(), truths.end(),
                                    [&](const NamedTrajectory& t) { return t.robot == robots[i].robot; });
    Series way{robots[i].robot, places(robots[i].poses, {}), charts::robot_colour(i), Series::Look::line};
    if (truth != truths.end()) {
      const Matched pairs = match(robots[i], *truth);
      if (pairs.truth.size() > 1) {
        const Pose2 T_map_truth = align_points(pairs.truth, pairs.estimated);
        map.series.push_back({i == 0 ? "truth" : "", places(truth->poses, T_map_truth), 0xB9C2CC, Series::Look::line});
        Series distance{robots[i].robot, {}, charts::robot_colour(i), Series::Look::line};
        for (std::size_t k = 0; k < pairs.truth.size(); ++k) {
          distance.points.emplace_back(pairs.stamps[k] - pairs.stamps.front(),
                                       (pairs.estimated[k] - T_map_truth * pairs.truth[k]).norm());
        }
        error.series.push_back(std::move(distance));
      }
    }
    map.series.push_back(std::move(way));
  }
  std::vector<Chart> charts{std::move(map)};
  if (!error.series.empty()) charts.push_back(std::move(error));
  return charts;
}

/// How far each relation is from where the fit left its patches.
std::vector<Chart> residual_charts(const Map& map) {
  constexpr RelationKind kKinds[] = {RelationKind::odometry, RelationKind::chain, RelationKind::overlap,
                                     RelationKind::closure, RelationKind::sighting};
  Chart position{
      "Relations against the fitted poses", "relation, in the order of making", "position [m]", {}, {}, false, 0.0};
  Chart heading{"", "relation, in the order of making", "heading [deg]", {}, {}, false, 0.0, 900, 380};
  for (std::size_t k = 0; k < std::size(kKinds); ++k) {
    Series distance{name_of(kKinds[k]), {}, charts::robot_colour(k), Series::Look::dots};
    Series turn = distance;
    turn.name.clear();
    for (std::size_t i = 0; i < map.relations().size(); ++i) {
      const Relation& r = map.relations()[i];
      if (r.kind != kKinds[k]) continue;
      const Pose2 fitted = map.T_plane_patch(r.a).inverse() * map.T_plane_patch(r.b);
      const Pose2 residual = r.T_a_b.inverse() * fitted;
      distance.points.emplace_back(static_cast<double>(i), residual.distance());
      turn.points.emplace_back(static_cast<double>(i), degrees(std::abs(residual.yaw)));
    }
    if (distance.points.empty()) continue;
    position.series.push_back(std::move(distance));
    heading.series.push_back(std::move(turn));
  }
  return {std::move(position), std::move(heading)};
}

std::vector<Chart> time_charts(const Json& summary) {
  Chart scans{fmt::format("CPU time a scan: half below {:.0f} us, 99 % below {:.0f} us",
                          summary.value("scan_us_p50", 0.0), summary.value("scan_us_p99", 0.0)),
              "tenth of the run",
              "mean [us]",
              {},
              {},
              false,
              0.0};
  Series tenths{"", {}, 0x0072B2, Series::Look::bars};
  double k = 0;
  for (const Json& value : summary.value("scan_us_by_tenth", Json::array())) {
    tenths.points.emplace_back(++k, value.get<double>());
  }
  scans.series.push_back(std::move(tenths));
  Chart phases{"", "", "CPU time [s]", {}, {}, false, 0.0, 900, 380};
  Series bars{"", {}, 0x009E73, Series::Look::bars};
  const Json by_phase = summary.value("phase_cpu_s", Json::object());
  for (const auto& [name, value] : by_phase.items()) {
    phases.x_names.push_back(name);
    bars.points.emplace_back(static_cast<double>(phases.x_names.size()), value.get<double>());
  }
  phases.series.push_back(std::move(bars));
  return {std::move(scans), std::move(phases)};
}

Result<Json> read_summary(const fs::path& folder) {
  std::ifstream file(folder / "summary.json");
  Json summary = Json::parse(file, nullptr, false);
  if (summary.is_discarded() || !summary.is_object()) {
    return fail("{}: has no summary.json; name a folder that `helicoid map` wrote", folder.string());
  }
  return summary;
}

int run_verb(const PlotArguments& a) {
  const fs::path folder(a.folder);
  const Result<Json> summary = read_summary(folder);
  if (!summary) return report_failure(summary.error().message);
  const auto robots = read_folder(folder / "trajectories");
  if (!robots) return report_failure(robots.error().message);
  std::vector<NamedTrajectory> truths;
  if (!a.truth.empty()) {
    auto read = read_folder(a.truth);
    if (!read) return report_failure(read.error().message);
    truths = std::move(*read);
  }
  const Result<Map> map = read_map((folder / "map.gpkg").string());
  if (!map) return report_failure(map.error().message);
  const fs::path out = a.out.empty() ? folder / "plots" : fs::path(a.out);
  const Result<OutputFolder> place = OutputFolder::open(out.string(), "trajectory.svg", a.force);
  if (!place) return report_failure(place.error().message);
  Json paths = Json::array();
  const std::pair<const char*, std::vector<Chart>> pictures[] = {{"trajectory.svg", trajectory_charts(*robots, truths)},
                                                                 {"residuals.svg", residual_charts(*map)},
                                                                 {"time.svg", time_charts(*summary)}};
  for (const auto& [name, charts] : pictures) {
    const std::string path = (out / name).string();
    if (auto done = write_whole_file(path, draw_charts(charts)); !done) return report_failure(done.error().message);
    if (!a.json) fmt::print("picture    {}\n", path);
    paths.push_back(path);
  }
  if (a.json) fmt::print("{}\n", Json{{"pictures", paths}}.dump(1));
  return kDone;
}

}  // namespace

void add_plot_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<PlotArguments>();
  CLI::App* verb = program.add_subcommand("plot", "Draw a map's trajectories, residuals and times as charts");
  verb->add_option("DIR", a->folder, "a folder that `helicoid map` wrote")->required();
  verb->add_option("--out", a->out, "where to write; default: DIR/plots");
  verb->add_option("--truth", a->truth,
                   "the folder of true trajectories (truth/ of a simulation): draws the error, too");
  verb->add_flag("--force", a->force, "write into a folder that something else made");
  verb->add_flag("--json", a->json, "print the pictures' paths as one JSON object");
  verb->footer("Examples:\n  helicoid plot site\n  helicoid plot site --truth sim/truth --out pictures");
  verb->callback([a, &exit_code] { exit_code = run_verb(*a); });
}

}  // namespace helicoid
