#include "apps/map_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "helicoid/io/robot_logs.hpp"
#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

/// Throws what the JSON library throws where something is missing.
MapArguments arguments_of(const Json& summary) {
  const Json& options = summary.at("options");
  MapArguments a;
  const auto laser = options.at("laser").get<std::string>();
  a.laser = laser == "recognised" ? "" : laser;
  a.every = options.at("every").get<std::size_t>();
  a.from = options.at("from").get<double>();
  if (options.at("to").is_number()) a.to = options.at("to").get<double>();
  a.no_charts = !options.at("charts").get<bool>();
  a.no_closures = !options.at("closures").get<bool>();
  a.join = options.at("join").get<std::string>();
  a.online = options.at("online").get<bool>();
  for (const Json& robot : summary.at("robots")) {
    a.named.push_back(robot.at("name").get<std::string>() + "=" + robot.at("log").get<std::string>());
  }
  return a;
}

Result<void> are_there(const std::vector<RobotLogs>& robots) {
  for (const RobotLogs& robot : robots) {
    for (const std::string& path : robot.paths) {
      std::error_code error;
      if (fs::exists(path, error)) continue;
      return fail(
          "{}: the log is not there; go to the folder where the map was made, or say where it is: --robot {}=LOG", path,
          robot.name);
    }
  }
  return {};
}

}  // namespace

std::string map_folder(const std::string& map) {
  std::error_code error;
  if (fs::is_directory(map, error)) return map;
  const std::string parent = fs::path(map).parent_path().string();
  return parent.empty() ? "." : parent;
}

Result<MapArguments> arguments_of_map(const std::string& folder, const std::vector<std::string>& named) {
  const std::string path = folder + "/summary.json";
  const Result<TextFile> text = read_text_file(path);
  if (!text) return fail("{}; is {} the folder of a map?", text.error().message, folder);
  MapArguments a;
  try {
    a = arguments_of(Json::parse(text->text));
  } catch (const std::exception& error) {
    return fail("{}: is no summary of a map ({}); map the logs again", path, error.what());
  }
  Result<std::vector<RobotLogs>> then = name_robots({}, a.named);
  if (!then) return tl::unexpected(then.error());
  Result<std::vector<RobotLogs>> now = name_robots({}, named);
  if (!now) return tl::unexpected(now.error());
  a.named.clear();
  for (RobotLogs& robot : *then) {
    const auto moved = std::find_if(now->begin(), now->end(), [&](const RobotLogs& n) { return n.name == robot.name; });
    if (moved != now->end()) robot.paths = moved->paths;
    a.named.push_back(fmt::format("{}={}", robot.name, fmt::join(robot.paths, ",")));
  }
  if (auto there = are_there(*then); !there) return tl::unexpected(there.error());
  return a;
}

}  // namespace helicoid
