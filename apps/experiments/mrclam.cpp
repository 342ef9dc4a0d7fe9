// Are robots that only see marks and one another found again by what they report?
#include <algorithm>
#include <cmath>

#include "apps/ceres_judge.hpp"
#include "apps/chart.hpp"
#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/team_outputs.hpp"
#include "helicoid/eval/trajectory_error.hpp"
#include "helicoid/simulation/mark_simulator.hpp"

namespace helicoid {

namespace {

constexpr const char* kFolder = "mrclam6";

TeamFitOptions with_landmarks(bool landmarks) {
  TeamFitOptions options;
  options.landmarks = landmarks;
  return options;
}

double islands_of_robots(const TeamFit& fit) {
  std::vector<std::uint32_t> islands;
  for (std::size_t i = 0; i < fit.nodes.robots(); ++i) islands.push_back(fit.island_of[fit.nodes.first_of(i)]);
  std::sort(islands.begin(), islands.end());
  return static_cast<double>(std::unique(islands.begin(), islands.end()) - islands.begin());
}

/// How far landmarks are off, after the transform that suits the robots best.
double landmark_error(const MrclamFolder& folder, const TeamFit& fit, const Pose2& T_world_plane) {
  double squares = 0;
  double count = 0;
  for (std::uint32_t node = fit.nodes.first_landmark(); node < fit.nodes.count(); ++node) {
    const auto truth = folder.landmarks.find(folder.log.landmarks[node - fit.nodes.first_landmark()]);
    if (truth == folder.landmarks.end()) continue;
    squares += (T_world_plane * fit.team.graph.poses[node].translation() - truth->second).squaredNorm();
    ++count;
  }
  return std::sqrt(squares / count);
}

Chart draw_ways(const TeamFit& fit, const MrclamFolder& folder) {
  Chart chart;
  chart.title = "five robots' ways and the marks they saw";
  chart.x_label = "x [m]";
  chart.y_label = "y [m]";
  chart.same_scale = true;
  chart.height = 700;
  for (std::size_t i = 0; i < folder.log.robots.size(); ++i) {
    Series way{folder.log.robots[i].name, {}, charts::robot_colour(i), Series::Look::line};
    for (const StampedEstimate& e : poses_at(folder.log, fit, i, steady_stamps(fit, i, 1))) {
      way.points.push_back(e.pose.translation());
    }
    chart.series.push_back(std::move(way));
  }
  Series marks{"landmarks", {}, charts::kWall, Series::Look::dots};
  for (std::uint32_t node = fit.nodes.first_landmark(); node < fit.nodes.count(); ++node) {
    marks.points.push_back(fit.team.graph.poses[node].translation());
  }
  if (!marks.points.empty()) chart.series.push_back(std::move(marks));
  return chart;
}

Chart draw_errors(const TeamError& error) {
  Chart chart;
  chart.title = fmt::format("error of each robot: {:.3f} m in all", error.rms_m);
  chart.y_label = "RMS [m]";
  chart.y_from = 0.0;
  chart.height = 260;
  Series bars{"", {}, charts::robot_colour(0), Series::Look::bars};
  for (std::size_t i = 0; i < error.robots_m.size(); ++i) {
    bars.points.emplace_back(static_cast<double>(i + 1), error.robots_m[i]);
    chart.x_names.push_back(fmt::format("robot{}", i + 1));
  }
  chart.series = {bars};
  return chart;
}

Result<Outcome> run_recorded(const std::string& data, bool landmarks) {
  const Result<MrclamFolder> folder = read_mrclam(fmt::format("{}/{}", data, kFolder));
  if (!folder) return tl::unexpected(folder.error());
  const double before = thread_cpu_seconds();
  const TeamFit fit = fit_team(folder->log, with_landmarks(landmarks));
  const double cpu_s = thread_cpu_seconds() - before;
  const TeamError error = score_team(*folder, fit);
  Outcome outcome;
  outcome.metrics = {{landmarks ? "rms_m" : "robots_only_rms_m", error.rms_m},
                     {"most_m", error.max_m},
                     {"heading_rms_deg", error.rms_deg},
                     {"scored_poses_count", static_cast<double>(error.matched)},
                     {"islands_count", islands_of_robots(fit)},
                     {"detections_count", static_cast<double>(fit.detections)},
                     {"wrong_detections_count", static_cast<double>(fit.wrong)},
                     {"rounds_count", static_cast<double>(fit.rounds)},
                     {"cpu_s", cpu_s}};
  if (landmarks) outcome.metrics.push_back({"landmarks_rms_m", landmark_error(*folder, fit, error.T_world_plane)});
  outcome.pictures = {
      {landmarks ? "landmarks" : "robots-only", draw_charts({draw_ways(fit, *folder), draw_errors(error)})}};
  return outcome;
}

/// The last round's factors, from where the rounds began, by either solver.
Result<Outcome> run_ceres(const std::string& data, bool landmarks) {
  const Result<MrclamFolder> folder = read_mrclam(fmt::format("{}/{}", data, kFolder));
  if (!folder) return tl::unexpected(folder.error());
  TeamFit ours = fit_team(folder->log, with_landmarks(landmarks));
  const GraphFile file = team_graph_file(ours.team.graph, ours.start);
  const Result<Judged> judged = judge(file, this_program());
  if (!judged) return tl::unexpected(judged.error());
  const FitResult again = fit(file.graph, file.fixed);
  ours.team.graph.poses = again.poses;
  const double rms = score_team(*folder, ours).rms_m;
  ours.team.graph.poses = judged->poses;
  const double ceres_rms = score_team(*folder, ours).rms_m;
  return Outcome{{{"fit_rms_m", rms},
                  {"ceres_rms_m", ceres_rms},
                  {"rms_over_ceres_ratio", rms / ceres_rms},
                  {"fit_cost", 2 * again.final_cost},
                  {"ceres_cost", judged->cost},
                  {"cost_over_ceres_ratio", 2 * again.final_cost / judged->cost},
                  {"fit_cpu_s", again.times.total_s},
                  {"ceres_cpu_s", judged->cpu_s},
                  {"fit_iterations_count", static_cast<double>(again.iterations)},
                  {"ceres_iterations_count", static_cast<double>(judged->iterations)}},
                 {}};
}

/// The constants of the estimate, one at a time, 30 % less and more.
std::vector<TeamFitOptions> varied_options() {
  std::vector<TeamFitOptions> varied;
  for (const double factor : {0.7, 1.3}) {
    for (double TeamFitOptions::*constant : {&TeamFitOptions::gate, &TeamFitOptions::gap, &TeamFitOptions::still}) {
      varied.emplace_back().*constant *= factor;
    }
    for (double TeamStartOptions::*constant : {&TeamStartOptions::step, &TeamStartOptions::recent}) {
      varied.emplace_back().start.*constant *= factor;
    }
  }
  return varied;
}

Result<Outcome> run_varied(const std::string& data) {
  const Result<MrclamFolder> folder = read_mrclam(fmt::format("{}/{}", data, kFolder));
  if (!folder) return tl::unexpected(folder.error());
  double least = HUGE_VAL;
  double most = 0;
  for (const TeamFitOptions& options : varied_options()) {
    const double rms = score_team(*folder, fit_team(folder->log, options)).rms_m;
    least = std::min(least, rms);
    most = std::max(most, rms);
  }
  return Outcome{{{"varied_least_rms_m", least}, {"varied_most_rms_m", most}}, {}};
}

Outcome run_simulated(std::uint64_t seed, double wrong) {
  MarkSimulation drive;
  drive.seed = seed;
  drive.wrong = wrong;
  const SimulatedTeam team = simulate_marks(drive);
  const double before = thread_cpu_seconds();
  const TeamFit fit = fit_team(team.log);
  const double cpu_s = thread_cpu_seconds() - before;
  MrclamFolder folder;
  folder.log = team.log;
  for (const std::vector<Pose2>& truth : team.truth) {
    std::vector<StampedPose>& stamped = folder.truth.emplace_back();
    for (std::size_t i = 0; i < truth.size(); ++i) stamped.push_back({team.stamps[i], truth[i]});
  }
  return Outcome{{{"rms_m", score_team(folder, fit).rms_m},
                  {"islands_count", islands_of_robots(fit)},
                  {"detections_count", static_cast<double>(fit.detections)},
                  {"truly_wrong_detections_count", static_cast<double>(team.wrong)},
                  {"wrong_detections_count", static_cast<double>(fit.wrong)},
                  {"cpu_s", cpu_s}},
                 {}};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  const std::string missing = missing_data(options, kFolder);
  const std::string no_judge = missing_judge(this_program());
  for (const bool landmarks : {true, false}) {
    const char* kind = landmarks ? "landmarks" : "robots-only";
    if (options.quick && !landmarks) continue;
    cases.push_back({fmt::format("{} {}", kFolder, kind), false, missing,
                     [=, data = options.data](std::uint64_t) { return run_recorded(data, landmarks); }});
    if (options.quick) continue;
    cases.push_back({fmt::format("{} {}, Ceres", kFolder, kind), false, missing.empty() ? no_judge : missing,
                     [=, data = options.data](std::uint64_t) { return run_ceres(data, landmarks); }});
  }
  if (!options.quick) {
    cases.push_back({fmt::format("{} landmarks, constants +-30 %", kFolder), false, missing,
                     [data = options.data](std::uint64_t) { return run_varied(data); }});
  }
  for (const double wrong : {0.0, 0.1, 0.3}) {
    cases.push_back({fmt::format("simulated, {:.0f} % wrong", 100 * wrong), true, "",
                     [wrong](std::uint64_t seed) -> Result<Outcome> { return run_simulated(seed, wrong); }});
  }
  return cases;
}

}  // namespace

Experiment mrclam_experiment() {
  Experiment e;
  e.name = "mrclam";
  e.question = "Are robots without lasers found again by what they see of marks and of one another?";
  e.method =
      "Five real robots (UTIAS MRCLAM, data set 6: 886 s) that are told velocities and measure range and bearing to "
      "barcodes on 15 landmarks and on one another; neither starts nor landmarks are known. All is fitted at once, "
      "with and without the landmarks, and compared with Vicon ten times a second, where it saw the robot, after one "
      "rigid transform for all five. Gains, delays, noise and wrong barcodes are learned from the residuals, by the "
      "same constants for any log, which are also varied by 30 %, one at a time. The same factors are also fitted by "
      "Ceres and by our own solver, both from where "
      "the rounds began. Simulated teams start anywhere on a floor of 6 by 10 m and drive for 300 s; of their barcodes "
      "none, a tenth or three tenths are taken for others.";
  e.bars = {{"rms_m", std::nullopt, 0.15, false},
            {"varied_most_rms_m", std::nullopt, 0.15, false},
            {"islands_count", std::nullopt, 1.0, false},
            {"cost_over_ceres_ratio", std::nullopt, 1.000001, false},
            {"rms_over_ceres_ratio", std::nullopt, 1.001, false}};
  e.seeds = 5;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
