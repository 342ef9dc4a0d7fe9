// helicoid explain: why a map believes that two places are, or are not, the same.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "apps/explanation.hpp"
#include "apps/map_folder.hpp"
#include "apps/verb.hpp"
#include "helicoid/store/map_file.hpp"

namespace helicoid {

namespace {

struct ExplainArguments {
  std::string map;
  std::string a;
  std::string b;
  bool json = false;
};

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The scan of the robot that is nearest in time.
Result<AskedPlace> place_of_robot(const Map& map, const std::string& asked, std::size_t at) {
  const std::optional<double> stamp = number(std::string_view(asked).substr(at + 1));
  if (!stamp) return fail("{}: after the @ stands a time in seconds, as in robot1@1312.5", asked);
  const std::string name = asked.substr(0, at);
  for (const RobotRecord& robot : map.robots()) {
    if (robot.name != name || robot.trajectory.empty()) continue;
    TrackedScan nearest = robot.trajectory.front();
    for (const TrackedScan& scan : robot.trajectory) {
      if (std::abs(scan.stamp - *stamp) < std::abs(nearest.stamp - *stamp)) nearest = scan;
    }
    if (std::abs(nearest.stamp - *stamp) > 10) {
      return fail("{}: {} has no scan within 10 s of that; its scans are from {:.2f} to {:.2f}", asked, name,
                  robot.trajectory.front().stamp, robot.trajectory.back().stamp);
    }
    return AskedPlace{asked, nearest.pose.patch, nearest.pose.T_patch_robot};
  }
  std::vector<std::string> names;
  for (const RobotRecord& robot : map.robots()) names.push_back(robot.name);
  return fail("{}: the map has no robot {}; it has {}", asked, name, fmt::join(names, ", "));
}

/// The nearest patch of the largest island, whose pictures stand in the map's folder.
Result<AskedPlace> place_of_point(const Map& map, const std::string& asked, std::size_t comma) {
  const std::optional<double> x = number(std::string_view(asked).substr(0, comma));
  const std::optional<double> y = number(std::string_view(asked).substr(comma + 1));
  if (!x || !y) return fail("{}: a point is x,y in metres, as in 12.5,-3", asked);
  const std::vector<Island> islands = map.islands();
  const auto largest = std::max_element(islands.begin(), islands.end(), [](const Island& p, const Island& q) {
    return p.patches.size() < q.patches.size();
  });
  if (largest == islands.end()) return fail("the map is empty");
  const Vector2d p_plane(*x, *y);
  const auto distance = [&](PatchId id) { return (map.T_plane_patch(id).translation() - p_plane).norm(); };
  const PatchId nearest = *std::min_element(largest->patches.begin(), largest->patches.end(),
                                            [&](PatchId p, PatchId q) { return distance(p) < distance(q); });
  if (distance(nearest) > 10) return fail("{}: the map has no patch within 10 m of that", asked);
  return AskedPlace{asked, nearest, map.T_plane_patch(nearest).inverse() * Pose2{*x, *y, 0}};
}

Result<AskedPlace> place_of(const Map& map, const std::string& asked) {
  if (const std::size_t at = asked.rfind('@'); at != std::string::npos) return place_of_robot(map, asked, at);
  if (const std::size_t comma = asked.find(','); comma != std::string::npos) return place_of_point(map, asked, comma);
  return fail("{}: a place is ROBOT@STAMP or x,y; an entry of the ledger is named alone, without a second place",
              asked);
}

Result<Explanation> explain(const ExplainArguments& a) {
  const std::string folder = map_folder(a.map);
  const Result<Map> map = read_map(folder + "/map.gpkg");
  if (!map) return tl::unexpected(map.error());
  const Result<std::vector<RecordedEntry>> ledger = read_ledger(folder + "/ledger.json");
  if (!ledger) return tl::unexpected(ledger.error());
  for (const RecordedEntry& entry : *ledger) {
    if (std::max(entry.hypothesis.a, entry.hypothesis.b).index() < map->patch_count()) continue;
    return fail("{}/ledger.json: speaks of patches that {}/map.gpkg does not have; map the logs again", folder, folder);
  }
  if (a.b.empty()) {
    std::size_t id = 0;
    const auto [end, error] = std::from_chars(a.a.data(), a.a.data() + a.a.size(), id);
    if (error != std::errc{} || end != a.a.data() + a.a.size()) {
      return fail("{}: name an entry of the ledger by its id, or two places (ROBOT@STAMP or x,y)", a.a);
    }
    if (id >= ledger->size()) {
      return fail("there is no entry {}; the ledger has {} (`helicoid ledger {}` lists them)", id, ledger->size(),
                  a.map);
    }
    return explain_entry(*map, *ledger, id);
  }
  const Result<AskedPlace> first = place_of(*map, a.a);
  if (!first) return tl::unexpected(first.error());
  const Result<AskedPlace> second = place_of(*map, a.b);
  if (!second) return tl::unexpected(second.error());
  return explain_places(*map, *ledger, *first, *second);
}

}  // namespace

void add_explain_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<ExplainArguments>();
  CLI::App* verb = program.add_subcommand("explain", "Say why a map believes what it believes about two places");
  verb->add_option("MAP", a->map, "a map's folder or its map.gpkg")->required();
  verb->add_option("A", a->a, "an entry of the ledger, ROBOT@STAMP, or x,y in the map's picture")->required();
  verb->add_option("B", a->b, "the other place; none for an entry");
  verb->add_flag("--json", a->json, "print one JSON object");
  verb->footer(
      "Examples:\n  helicoid explain site 17\n  helicoid explain site robot1@1312.5 robot2@87.3\n"
      "  helicoid explain site 0,0 12.5,-3\n"
      "`helicoid ledger site` lists the entries.");
  verb->callback([a, &exit_code] {
    const Result<Explanation> answer = explain(*a);
    if (!answer) {
      exit_code = report_failure(answer.error().message);
    } else if (a->json) {
      nlohmann::ordered_json json = answer->figures;
      json["text"] = answer->paragraphs;
      fmt::print("{}\n", json.dump(1));
    } else {
      fmt::print("{}\n", fmt::join(answer->paragraphs, "\n\n"));
    }
  });
}

}  // namespace helicoid
