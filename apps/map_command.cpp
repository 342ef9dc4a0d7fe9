#include "apps/map_command.hpp"

#include <algorithm>
#include <cstdio>

#include "apps/decisions_file.hpp"
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

/// What decides the result; not where it goes and not how many threads work.
Json options_json(const MapArguments& a, std::size_t decisions) {
  Json json = {{"laser", a.laser.empty() ? "recognised" : a.laser},
               {"every", a.every},
               {"from", a.from},
               {"to", a.to < 1e300 ? Json(a.to) : Json()},
               {"charts", !a.no_charts},
               {"closures", !a.no_closures},
               {"join", a.join},
               {"decisions", decisions},
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

/// Decisions about entries that did not come up: the logs or the options are others than those that they are about.
std::size_t warn_of_unused(const MapRun& run, const std::vector<Decision>& decisions) {
  std::vector<bool> used(decisions.size(), false);
  for (const Hypothesis& h : run.mapper.ledger()) {
    const Decision* decision = find_decision(decisions, run.mapper.map(), h);
    if (decision != nullptr) used[static_cast<std::size_t>(decision - decisions.data())] = true;
  }
  const auto unused = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  if (unused == 0) return 0;
  const Decision& d = decisions[static_cast<std::size_t>(std::find(used.begin(), used.end(), false) - used.begin())];
  report_warning(
      fmt::format("{} x decision that met no entry of the ledger, first that about {}@{} and {}@{}; are these "
                  "the logs and options that it was made about?",
                  unused, d.a.robot, d.a.stamp, d.b.robot, d.b.stamp));
  return unused;
}

int finish(MapRun& run, const std::vector<Decision>& decisions, const MapArguments& a) {
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
  if (auto done = write_records(run, a.out, a.online); !done) return report_failure(done.error().message);
  if (!decisions.empty()) {
    auto done = write_whole_file(a.out + "/decisions.json", decisions_json(decisions));
    if (!done) return report_failure(done.error().message);
  }
  run.phase.write = thread_cpu_seconds() - before_write;
  const Json summary = summarise(run, report, options_json(a, decisions.size()));
  if (auto done = write_whole_file(a.out + "/summary.json", summary.dump(1) + "\n"); !done) {
    return report_failure(done.error().message);
  }
  for (const std::string& warning : run.warnings) report_warning(warning);
  for (const Skipped& s : run.skipped) {
    report_warning(fmt::format("{} x {}{}", s.count, s.reason, s.first.empty() ? "" : ", first at " + s.first));
  }
  const std::size_t unused = warn_of_unused(run, decisions);
  if (run.interrupted) report_warning("interrupted: the map holds what was read until then");
  if (a.json) {
    fmt::print("{}\n", summary.dump(1));
  } else {
    print_report(run, summary, a, files);
  }
  return run.interrupted || unused > 0 ? kNotAsAsked : kDone;
}

/// The decisions of the command line, or those that a replay was given.
Result<std::vector<Decision>> decisions_of(const MapArguments& a) {
  return a.decisions_file.empty() ? a.decisions : read_decisions(a.decisions_file);
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
  add("--decisions", !a.decisions_file.empty());
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

}  // namespace

int run_map_command(const MapArguments& a) {
  const auto team = std::find_if(a.logs.begin(), a.logs.end(), is_mrclam_folder);
  if (team != a.logs.end()) return run_team_folder(*team, a);
  Result<std::vector<RobotLogs>> robots = name_robots(a.logs, a.named);
  if (!robots) return report_failure(robots.error().message);
  Result<std::vector<Decision>> decisions = decisions_of(a);
  if (!decisions) return report_failure(decisions.error().message);
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
  job.mapper.decisions = std::move(*decisions);
  job.progress = [&bar](double share) { bar.show(share, "mapping"); };
  Result<MapRun> run = run_map(job);
  if (!run) return report_failure(run.error().message);
  folder->clear_old_results();
  return finish(*run, job.mapper.decisions, a);
}

}  // namespace helicoid
