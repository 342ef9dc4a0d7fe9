#include "apps/map_team.hpp"

#include <cstdio>

#include "apps/output_folder.hpp"
#include "apps/progress_bar.hpp"
#include "apps/team_outputs.hpp"
#include "apps/verb.hpp"
#include "helicoid/base/whole_file.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

void print_report(const TeamRun& run, const Json& summary, const TeamMapArguments& a) {
  fmt::print("no scans   the robots have no lasers: there is no grid and no sketch to draw\n");
  fmt::print("detections {}, {} of them wrong\n", run.fit.detections, run.fit.wrong);
  for (const Json& island : summary["islands"]) {
    fmt::print("island {:<4}{}; {} landmarks\n", island["id"].get<std::size_t>(),
               fmt::join(island["robots"].get<std::vector<std::string>>(), ", "), island["landmarks"].size());
  }
  for (std::size_t i = 0; i < run.trajectories.size(); ++i) {
    const OdometryModel& o = run.fit.model.odometry[i];
    const DetectionModel& d = run.fit.model.detection[i];
    fmt::print(
        "{:<11}drives {:.3f} and turns {:.3f} of what it is told, {:.2f} s later; sees ranges to {:.0f} mm + "
        "{:.1f} %, bearings to {:.2f} deg\n",
        run.folder.log.robots[i].name, o.forward_gain, o.turning_gain, o.delay, 1000 * d.range_floor,
        100 * d.range_share, degrees(d.bearing_sigma));
  }
  fmt::print("fit        {} relations, {} after {} rounds, cost {:.3f}\n", summary["relations"].get<std::size_t>(),
             summary["status"].get<std::string>(), run.fit.rounds, summary["final_cost"].get<double>());
  fmt::print("cpu        {:.3f} s, {:.0f} MB\n", summary["cpu_s"].get<double>(), summary["peak_rss_mb"].get<double>());
  fmt::print("poses      {}/trajectories\n", a.out);
  if (!a.no_charts) fmt::print("picture    {}/map.svg\n", a.out);
}

void report_warnings(const TeamRun& run) {
  for (const std::string& warning : run.folder.warnings) report_warning(warning);
  for (const Skipped& s : run.folder.skipped) {
    report_warning(fmt::format("{} x {}, first at {}", s.count, s.reason, s.first));
  }
  if (!run.fit.is_still) report_warning("the robots are not known well enough yet: poses were still moving");
  if (run.interrupted) report_warning("interrupted: the poses are those of the last fit until then");
}

int finish(TeamRun& run, const TeamMapArguments& a) {
  const double before_charts = thread_cpu_seconds();
  if (!a.no_charts) {
    if (auto done = write_whole_file(a.out + "/map.svg", draw_team(run)); !done) {
      return report_failure(done.error().message);
    }
  }
  const double before_write = thread_cpu_seconds();
  run.phase.charts = before_write - before_charts;
  if (auto done = write_team_records(run, a.out); !done) return report_failure(done.error().message);
  run.phase.write = thread_cpu_seconds() - before_write;
  const Json summary = summarise_team(run, a.folder, {{"charts", !a.no_charts}});
  if (auto done = write_whole_file(a.out + "/summary.json", summary.dump(1) + "\n"); !done) {
    return report_failure(done.error().message);
  }
  report_warnings(run);
  if (a.json) {
    fmt::print("{}\n", summary.dump(1));
  } else {
    print_report(run, summary, a);
  }
  return run.interrupted || !run.fit.is_still ? kNotAsAsked : kDone;
}

}  // namespace

int map_team(const TeamMapArguments& arguments) {
  const Result<OutputFolder> folder = OutputFolder::open(arguments.out, "summary.json", arguments.force);
  if (!folder) return report_failure(folder.error().message);
  ProgressBar bar;
  Result<TeamRun> run = run_team(arguments.folder, {}, [&bar](double share) { bar.show(share, "fitting"); });
  if (!run) return report_failure(run.error().message);
  folder->clear_old_results();
  return finish(*run, arguments);
}

}  // namespace helicoid
