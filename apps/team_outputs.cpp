#include "apps/team_outputs.hpp"

#include <cmath>
#include <filesystem>
#include <numeric>

#include "apps/chart.hpp"
#include "apps/map_summary.hpp"
#include "helicoid/base/whole_file.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(std::optional<std::size_t> number) {
  return number ? Json(*number) : Json();
}

double rounded(double value, double digits) {
  return std::round(value * digits) / digits;
}

/// How often each subject was seen, wrong detections left out.
std::vector<std::size_t> count_detections(const TeamRun& run) {
  std::vector<std::size_t> counts(run.folder.log.robots.size() + run.folder.log.landmarks.size(), 0);
  for (const DetectionPlace& place : run.fit.team.detections) {
    ++counts[run.folder.log.robots[place.robot].detections[place.index].subject];
  }
  return counts;
}

Json robots_json(const TeamRun& run, const std::string& folder) {
  Json robots = Json::array();
  for (std::size_t i = 0; i < run.trajectories.size(); ++i) {
    const TeamRobot& robot = run.folder.log.robots[i];
    const OdometryModel& o = run.fit.model.odometry[i];
    const DetectionModel& d = run.fit.model.detection[i];
    robots.push_back({{"name", robot.name},
                      {"log", folder},
                      {"scans", 0},
                      {"poses", run.trajectories[i].size()},
                      {"detections", robot.detections.size()},
                      {"island", number_or_null(run.island_of_robot(i))},
                      {"odometry",
                       {{"forward_gain", rounded(o.forward_gain, 1e4)},
                        {"sideways_gain", rounded(o.sideways_gain, 1e4)},
                        {"turning_gain", rounded(o.turning_gain, 1e4)},
                        {"veer_rad_per_m", rounded(o.veer, 1e4)},
                        {"delay_s", rounded(o.delay, 1e4)}}},
                      {"detection",
                       {{"range_floor_m", rounded(d.range_floor, 1e5)},
                        {"range_share", rounded(d.range_share, 1e5)},
                        {"bearing_sigma_deg", rounded(degrees(d.bearing_sigma), 1e4)},
                        {"range_kappa", rounded(d.range_kappa, 100)},
                        {"bearing_kappa", rounded(d.bearing_kappa, 100)}}}});
  }
  return robots;
}

Json landmarks_json(const TeamRun& run) {
  Json landmarks = Json::array();
  const std::vector<std::size_t> counts = count_detections(run);
  for (std::size_t i = 0; i < run.folder.log.landmarks.size(); ++i) {
    const auto node = run.fit.nodes.first_landmark() + static_cast<std::uint32_t>(i);
    if (node >= run.fit.nodes.count()) break;
    const auto island = run.island_of_landmark(i);
    const Pose2 place = run.pose_of(node);
    landmarks.push_back({{"name", run.folder.log.landmarks[i]},
                         {"island", number_or_null(island)},
                         {"x", island ? Json(rounded(place.x, 1e6)) : Json()},
                         {"y", island ? Json(rounded(place.y, 1e6)) : Json()},
                         {"detections", counts[run.trajectories.size() + i]}});
  }
  return landmarks;
}

Json islands_json(const TeamRun& run) {
  Json islands = Json::array();
  for (std::size_t i = 0; i < run.islands.size(); ++i) {
    std::vector<std::string> robots;
    std::vector<std::string> landmarks;
    for (const std::size_t k : run.islands[i].robots) robots.push_back(run.folder.log.robots[k].name);
    for (const std::size_t k : run.islands[i].landmarks) landmarks.push_back(run.folder.log.landmarks[k]);
    islands.push_back({{"id", i}, {"robots", robots}, {"landmarks", landmarks}});
  }
  return islands;
}

const char* name_of(const TeamFit& fit) {
  if (fit.result.status == FitStatus::not_positive_definite) return "not determined";
  if (fit.result.status == FitStatus::nothing_to_fit) return "nothing to fit";
  return fit.is_still && fit.result.status == FitStatus::converged ? "converged" : "iteration limit";
}

Chart chart_of(const TeamRun& run, const TeamIsland& island) {
  Chart chart;
  std::vector<std::string> names;
  for (const std::size_t i : island.robots) names.push_back(run.folder.log.robots[i].name);
  chart.title = fmt::format("{}", fmt::join(names, ", "));
  chart.x_label = "x [m]";
  chart.y_label = "y [m]";
  chart.same_scale = true;
  chart.height = 820;
  for (const std::size_t i : island.robots) {
    Series way{names[chart.series.size()], {}, charts::robot_colour(i), Series::Look::line};
    for (const StampedPose& p : run.trajectories[i]) way.points.push_back(p.pose.translation());
    chart.series.push_back(std::move(way));
  }
  Series marks{"landmarks", {}, charts::kWall, Series::Look::dots};
  for (const std::size_t i : island.landmarks) {
    marks.points.push_back(run.pose_of(run.fit.nodes.first_landmark() + static_cast<std::uint32_t>(i)).translation());
  }
  if (!marks.points.empty()) chart.series.push_back(std::move(marks));
  return chart;
}

/// g2o's EDGE_SE2_XY ends at a landmark: the place of another robot is a pose of which no heading is known.
Measurement as_pose(const PointPosition& m) {
  PosePose pose{{m.p_a.x(), m.p_a.y(), 0}, Matrix3d::Zero()};
  pose.information.topLeftCorner<2, 2>() = m.information;
  return pose;
}

}  // namespace

GraphFile team_graph_file(const RelationGraph& graph, std::vector<Pose2> poses) {
  GraphFile file;
  file.graph = graph;
  file.graph.poses = std::move(poses);
  file.ids.resize(graph.poses.size());
  std::iota(file.ids.begin(), file.ids.end(), 0);
  file.fixed = default_gauge(graph);
  for (GraphRelation& r : file.graph.relations) {
    const auto* place = std::get_if<PointPosition>(&r.measurement);
    if (place != nullptr && !graph.is_landmark[r.b]) r.measurement = as_pose(*place);
  }
  return file;
}

Result<void> write_team_records(const TeamRun& run, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder + "/trajectories", error);
  for (std::size_t i = 0; i < run.trajectories.size(); ++i) {
    const std::string path = fmt::format("{}/trajectories/{}.tum", folder, run.folder.log.robots[i].name);
    if (auto done = write_whole_file(path, to_tum(run.trajectories[i])); !done) return done;
  }
  std::vector<Pose2> poses;
  for (std::uint32_t node = 0; node < run.fit.nodes.count(); ++node) poses.push_back(run.pose_of(node));
  const GraphFile file = team_graph_file(run.fit.team.graph, std::move(poses));
  return write_whole_file(folder + "/graph.g2o", to_graph_text(file, file.graph.poses));
}

std::string draw_team(const TeamRun& run) {
  std::vector<Chart> charts;
  for (const TeamIsland& island : run.islands) charts.push_back(chart_of(run, island));
  return draw_charts(charts);
}

Json summarise_team(const TeamRun& run, const std::string& folder, const Json& options) {
  Json json = {{"format", "helicoid-map-summary"}, {"version", HELICOID_VERSION}, {"options", options}};
  json["inputs"] = {folder};
  json["robots"] = robots_json(run, folder);
  json["landmarks"] = landmarks_json(run);
  json["scans"] = 0;
  json["relations"] = run.fit.team.graph.relations.size();
  json["detections"] = run.fit.detections;
  json["wrong_detections"] = run.fit.wrong;
  json["island_count"] = run.islands.size();
  json["islands"] = islands_json(run);
  json["final_cost"] = rounded(2 * run.fit.result.final_cost, 1e6);
  json["rounds"] = run.fit.rounds;
  json["status"] = name_of(run.fit);
  json.update(process_figures(std::chrono::duration<double>(std::chrono::steady_clock::now() - run.began).count()));
  json["phase_cpu_s"] = phase_figures(run.phase);
  json["skipped"] = skipped_json(run.folder.skipped);
  json["warnings"] = run.folder.warnings;
  return json;
}

}  // namespace helicoid
