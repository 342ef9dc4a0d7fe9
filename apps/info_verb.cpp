// helicoid info: what is this file?
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/map_summary.hpp"
#include "apps/verb.hpp"
#include "helicoid/io/mrclam_reader.hpp"
#include "helicoid/io/relations_file.hpp"
#include "helicoid/io/robot_logs.hpp"
#include "helicoid/io/trajectory.hpp"
#include "helicoid/manifold/content_hash.hpp"
#include "helicoid/store/map_file.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

Json describe_map(const Map& map, const std::string& path) {
  Json json = {{"file", path},
               {"kind", "map"},
               {"content_hash", content_hash(map).hex()},
               {"patches", map.patch_count()},
               {"relations", map.relations().size()},
               {"islands", map.islands().size()}};
  Json robots = Json::array();
  for (const RobotRecord& robot : map.robots()) {
    robots.push_back({{"name", robot.name},
                      {"scans", robot.trajectory.size()},
                      {"laser", robot.lasers.empty() ? "" : describe(robot.lasers.front())}});
  }
  json["robots"] = robots;
  return json;
}

Json describe_log(MergedLogs& logs, const std::string& path) {
  Json json = {{"file", path}, {"kind", "CARMEN log"}};
  std::size_t scans = 0, odometry = 0, sightings = 0, lookalikes = 0, backwards = 0;
  double first = 0, last = 0, length = 0;
  Pose2 previous;
  while (const Event* event = logs.next()) {
    if (scans + odometry + sightings + lookalikes == 0) first = last = event->stamp;
    if (event->stamp < last) ++backwards;
    last = std::max(last, event->stamp);
    if (const auto* scan = std::get_if<Scan>(&event->body)) {
      if (scans++ > 0) length += (previous.inverse() * scan->T_odom_robot).distance();
      previous = scan->T_odom_robot;
    } else if (std::holds_alternative<Odometry>(event->body)) {
      ++odometry;
    } else if (std::holds_alternative<Sighting>(event->body)) {
      ++sightings;
    } else {
      ++lookalikes;
    }
  }
  const CarmenReader& reader = *logs.robots().front().reader;
  Json lasers = Json::array();
  for (const LaserModel& laser : reader.lasers()) lasers.push_back(describe(laser));
  json.update({{"lasers", lasers},
               {"scans", scans},
               {"odometry", odometry},
               {"sightings", sightings},
               {"lookalikes", lookalikes},
               {"duration_s", last - first},
               {"odometry_path_m", length},
               {"stamps_going_back", backwards},
               {"skipped", skipped_json(reader.skipped())},
               {"warnings", reader.warnings()}});
  return json;
}

Json describe_team(const MrclamFolder& folder, const std::string& path) {
  Json robots = Json::array();
  double first = HUGE_VAL;
  double last = -HUGE_VAL;
  for (std::size_t i = 0; i < folder.log.robots.size(); ++i) {
    const TeamRobot& robot = folder.log.robots[i];
    first = std::min(first, robot.velocities.front().stamp);
    last = std::max(last, robot.velocities.back().stamp);
    robots.push_back({{"name", robot.name},
                      {"velocities", robot.velocities.size()},
                      {"detections", robot.detections.size()},
                      {"true_poses", folder.truth[i].size()}});
  }
  return {{"file", path},
          {"kind", "MRCLAM folder"},
          {"robots", robots},
          {"landmarks", folder.log.landmarks.size()},
          {"duration_s", last - first},
          {"skipped", skipped_json(folder.skipped)},
          {"warnings", folder.warnings}};
}

/// The first reading that succeeds; the errors of the others are of no interest, except if all fail.
Result<Json> look_at(const std::string& path) {
  if (is_mrclam_folder(path)) {
    const Result<MrclamFolder> folder = read_mrclam(path);
    if (!folder) return tl::unexpected(folder.error());
    return describe_team(*folder, path);
  }
  const Result<TextFile> text = read_text_file(path);
  if (!text) return tl::unexpected(text.error());
  if (text->text.starts_with("SQLite format 3")) {
    const Result<Map> map = read_map(path);
    if (!map) return tl::unexpected(map.error());
    return describe_map(*map, path);
  }
  if (looks_binary(text->text)) return fail("{}: is a binary file that Helicoid does not know", path);
  Result<MergedLogs> logs = MergedLogs::open({{"robot", {path}}});
  if (logs) return describe_log(*logs, path);
  if (const TumFile tum = parse_tum(text->text, path); !tum.poses.empty() && tum.skipped.empty()) {
    double length = 0;
    for (std::size_t i = 1; i < tum.poses.size(); ++i) {
      length += (tum.poses[i - 1].pose.inverse() * tum.poses[i].pose).distance();
    }
    return Json{{"file", path},
                {"kind", "TUM trajectory"},
                {"poses", tum.poses.size()},
                {"duration_s", tum.poses.back().stamp - tum.poses.front().stamp},
                {"path_m", length}};
  }
  if (const RelationsFile relations = parse_relations(text->text, path); !relations.relations.empty()) {
    return Json{{"file", path}, {"kind", "relations"}, {"relations", relations.relations.size()}};
  }
  return fail("{}: is no log, map, trajectory or relations file that Helicoid knows", path);
}

}  // namespace

void add_info_verb(CLI::App& program, int& exit_code) {
  struct InfoArguments {
    std::string file;
    bool json = false;
  };
  auto a = std::make_shared<InfoArguments>();
  CLI::App* verb = program.add_subcommand("info", "Say what a file is and what is in it");
  verb->add_option("FILE", a->file, "a log, a map (map.gpkg), a trajectory, a relations file or an MRCLAM folder")
      ->required();
  verb->add_flag("--json", a->json, "print one JSON object");
  verb->footer(
      "Examples:\n  helicoid info robot1.clf.gz\n  helicoid info site/map.gpkg\n"
      "Two maps are equal to the bit exactly when their content hashes are equal.");
  verb->callback([a, &exit_code] {
    const Result<Json> json = look_at(a->file);
    if (!json) {
      exit_code = report_failure(json.error().message);
    } else if (a->json) {
      fmt::print("{}\n", json->dump(1));
    } else {
      for (const auto& [key, value] : json->items()) {
        fmt::print("{:<18} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
      }
    }
  });
}

}  // namespace helicoid
