// helicoid map: logs in, a map out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/map_summary.hpp"
#include "apps/map_team.hpp"
#include "apps/output_folder.hpp"
#include "apps/progress_bar.hpp"
#include "apps/verb.hpp"
#include "helicoid/base/whole_file.hpp"
#include "helicoid/io/mrclam_reader.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

struct MapArguments {
  std::vector<std::string> logs;
  std::vector<std::string> named;
  std::string out;
  std::string laser;
  std::string join = "sightings";
  std::size_t every = 1;
  double from = 0;
  double to = 1e300;
  int threads = 1;
  bool no_charts = false;
  bool no_closures = false;
  bool online = false;
  bool force = false;
  bool json = false;
};

/// What decides the result; not where it goes and not how many threads work.
Json options_json(const MapArguments& a) {
  Json json = {{"laser", a.laser.empty() ? "recognised" : a.laser},
               {"every", a.every},
               {"from", a.from},
               {"to", a.to < 1e300 ? Json(a.to) : Json()},
               {"charts", !a.no_charts},
               {"closures", !a.no_closures},
               {"join", a.join},
               {"online", a.online}};
  return json;
}

void print_report(const MapRun& run, const Json& summary, const MapArguments& a,
                  const std::vector<std::string>& files) {
  for (const std::string& laser : run.lasers) fmt::print("laser      {}\n", laser);
  fmt::print("scans      {}\npatches    {}, {} related pairs, {} correspondences\n",
             summary["scans"].get<std::size_t>(), summary["patches"].get<std::size_t>(),
             summary["relations"].get<std::size_t>(), summary["correspondences"].get<std::size_t>());
  for (const auto& island : summary["islands"]) {
    fmt::print("island {:<4}{} patches, {:.1f} m2, {} ({})\n", island["id"].get<std::size_t>(),
               island["patches"].get<std::size_t>(), island["area_m2"].get<double>(),
               island["sheets"].get<int>() == 1 ? "planar" : fmt::format("{} sheets", island["sheets"].get<int>()),
               fmt::join(island["robots"].get<std::vector<std::string>>(), ", "));
  }
  const auto& closures = summary["closures"];
  fmt::print("loops      {} look-alikes accepted, {} open\n", closures["accepted"].get<int>(),
             closures["open"].get<int>());
  fmt::print("cpu        {:.3f} s, {:.0f} us a scan (99 %: {:.0f} us), {:.0f} MB\n", summary["cpu_s"].get<double>(),
             summary["scan_us_p50"].get<double>(), summary["scan_us_p99"].get<double>(),
             summary["peak_rss_mb"].get<double>());
  const auto& phase = summary["phase_cpu_s"];
  fmt::print("           read {:.3f}, match {:.3f}, fit {:.3f}, close {:.3f}, charts {:.3f}, write {:.3f}\n",
             phase["read"].get<double>(), phase["match"].get<double>(), phase["fit"].get<double>(),
             phase["close"].get<double>(), phase["charts"].get<double>(), phase["write"].get<double>());
  fmt::print("map        {}/map.gpkg\n", a.out);
  for (std::size_t i = 0; i < std::min<std::size_t>(files.size(), 6); ++i) fmt::print("picture    {}\n", files[i]);
  if (files.size() > 6) fmt::print("           and {} more\n", files.size() - 6);
}

int finish(MapRun& run, const MapArguments& a) {
  const double before_report = thread_cpu_seconds();
  const MapReport report = report_on(run.mapper.map(), !a.no_charts);
  const double before_charts = thread_cpu_seconds();
  std::vector<std::string> files;
  if (!a.no_charts) {
    Result<std::vector<std::string>> charts = write_charts(run.mapper.map(), report, a.out, a.threads);
    if (!charts) return report_failure(charts.error().message);
    files = std::move(*charts);
  }
  const double before_write = thread_cpu_seconds();
  run.phase.fit += before_charts - before_report;
  run.phase.charts = before_write - before_charts;
  if (auto done = write_records(run, report, a.out, a.online); !done) return report_failure(done.error().message);
  run.phase.write = thread_cpu_seconds() - before_write;
  const Json summary = summarise(run, report, options_json(a));
  if (auto done = write_whole_file(a.out + "/summary.json", summary.dump(1) + "\n"); !done) {
    return report_failure(done.error().message);
  }
  for (const std::string& warning : run.warnings) report_warning(warning);
  for (const Skipped& s : run.skipped) {
    report_warning(fmt::format("{} x {}{}", s.count, s.reason, s.first.empty() ? "" : ", first at " + s.first));
  }
  if (run.interrupted) report_warning("interrupted: the map holds what was read until then");
  if (a.json) {
    fmt::print("{}\n", summary.dump(1));
  } else {
    print_report(run, summary, a, files);
  }
  return run.interrupted ? kNotAsAsked : kDone;
}

/// The options given that have no meaning without scans.
std::vector<std::string> scan_options(const MapArguments& a) {
  std::vector<std::string> given;
  const auto add = [&](const char* name, bool is_given) {
    if (is_given) given.emplace_back(name);
  };
  add("--robot", !a.named.empty());
  add("--laser", !a.laser.empty());
  add("--join", a.join != "sightings");
  add("--every", a.every != 1);
  add("--from", a.from != 0);
  add("--to", a.to < 1e300);
  add("--no-closures", a.no_closures);
  add("--online", a.online);
  return given;
}

int run_team_folder(const std::string& folder, const MapArguments& a) {
  if (a.logs.size() > 1) {
    return report_failure(fmt::format("{}: is an MRCLAM folder, a team of its own; name it alone", folder));
  }
  if (const std::vector<std::string> given = scan_options(a); !given.empty()) {
    return report_failure(
        fmt::format("{}: is an MRCLAM folder and holds no laser scans; leave out {}, which say{} "
                    "what to do with scans",
                    folder, fmt::join(given, ", "), given.size() == 1 ? "s" : ""));
  }
  return map_team({folder, a.out, a.no_charts, a.force, a.json});
}

int run_verb(const MapArguments& a) {
  const auto team = std::find_if(a.logs.begin(), a.logs.end(), is_mrclam_folder);
  if (team != a.logs.end()) return run_team_folder(*team, a);
  Result<std::vector<RobotLogs>> robots = name_robots(a.logs, a.named);
  if (!robots) return report_failure(robots.error().message);
  const Result<OutputFolder> folder = OutputFolder::open(a.out, "summary.json", a.force);
  if (!folder) return report_failure(folder.error().message);
  ProgressBar bar;
  MapJob job;
  job.robots = std::move(*robots);
  job.laser = a.laser;
  job.every = a.every;
  job.from = a.from;
  job.to = a.to;
  job.mapper.closures = !a.no_closures;
  job.mapper.join_on_evidence = a.join == "evidence";
  job.progress = [&bar](double share) { bar.show(share, "mapping"); };
  Result<MapRun> run = run_map(job);
  if (!run) return report_failure(run.error().message);
  folder->clear_old_results();
  return finish(*run, a);
}

}  // namespace

void add_map_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<MapArguments>();
  CLI::App* verb = program.add_subcommand("map", "Map the logs of one or more robots");
  verb->add_option(
      "LOG", a->logs,
      "CARMEN logs, plain or .gz, - for stdin; each is a robot named by its base name; or one MRCLAM folder");
  verb->add_option("--robot", a->named, "NAME=LOG[,LOG...]: a robot with a name and one or more logs")->take_all();
  verb->add_option("--out", a->out, "the folder to write into")->required();
  verb->add_option("--laser", a->laser, "a laser's name (sick-lms200, hokuyo-urg, ...) or a file; default: recognised");
  verb->add_option("--join", a->join, "what may join islands")
      ->check(CLI::IsMember({"sightings", "evidence"}))
      ->capture_default_str();
  verb->add_option("--every", a->every, "map only every N-th scan")->check(CLI::PositiveNumber)->capture_default_str();
  verb->add_option("--from", a->from, "start this many seconds after a robot's first scan");
  verb->add_option("--to", a->to, "stop this many seconds after a robot's first scan");
  verb->add_option("--threads", a->threads, "threads that draw; the result does not depend on it")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb->add_flag("--no-charts", a->no_charts, "write no pictures");
  verb->add_flag("--no-closures", a->no_closures, "close no loops: a loop stays a spiral");
  verb->add_flag("--online", a->online,
                 "trajectories: each pose as the robot would have had it then, not as it is known now");
  verb->add_flag("--force", a->force, "write into a folder that something else made");
  verb->add_flag("--json", a->json, "print the summary as one JSON object");
  verb->footer(
      "Examples:\n  helicoid map robot1.log.gz --out site\n"
      "  helicoid map a.log b.log --out team --threads 2\n"
      "  helicoid map mrclam6 --out five-robots\n"
      "  helicoid map --robot r2=monday.log,tuesday.log --out site --no-charts --json");
  verb->callback([a, &exit_code] {
    if (a->logs.empty() && a->named.empty()) throw CLI::RequiredError("LOG or --robot");
    exit_code = run_verb(*a);
  });
}

}  // namespace helicoid
