#include "apps/map_summary.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <numeric>

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// Microseconds, to a tenth.
double micro(double s) {
  return std::round(1e7 * s) / 10;
}
double milli(double s) {
  return std::round(1e6 * s) / 1e6;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// Mean time a scan in each tenth of the run.
Json by_tenth(const std::vector<double>& values) {
  Json tenths = Json::array();
  for (std::size_t k = 0; k < 10; ++k) {
    const std::size_t first = k * values.size() / 10;
    const std::size_t last = (k + 1) * values.size() / 10;
    const double sum = std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first),
                                       values.begin() + static_cast<std::ptrdiff_t>(last), 0.0);
    tenths.push_back(last > first ? micro(sum / static_cast<double>(last - first)) : 0.0);
  }
  return tenths;
}

void add_contents(Json& json, const Map& map, const MapReport& report) {
  std::size_t scans = 0;
  for (const RobotRecord& robot : map.robots()) scans += robot.trajectory.size();
  std::vector<std::pair<PatchId, PatchId>> pairs;
  std::size_t correspondences = 0;
  for (const Relation& r : map.relations()) {
    pairs.emplace_back(r.a, r.b);
    correspondences += static_cast<std::size_t>(r.correspondences);
  }
  std::sort(pairs.begin(), pairs.end());
  json["scans"] = scans;
  json["patches"] = map.patch_count();
  json["relations"] = std::unique(pairs.begin(), pairs.end()) - pairs.begin();
  json["correspondences"] = correspondences;
  int sheets = 1;
  Json islands = Json::array();
  for (const IslandReport& i : report.islands) {
    sheets = std::max(sheets, i.sheets.count);
    islands.push_back({{"id", i.island.id.value},
                       {"robots", i.robots},
                       {"patches", i.island.patches.size()},
                       {"sheets", i.sheets.count},
                       {"area_m2", std::round(100 * i.area_m2) / 100}});
  }
  json["sheets"] = sheets;
  json["island_count"] = report.islands.size();
  json["islands"] = islands;
}

}  // namespace

Json process_figures(double wall_seconds) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {{"cpu_s", milli(seconds(usage.ru_utime) + seconds(usage.ru_stime))},
          {"wall_s", milli(wall_seconds)},
          {"peak_rss_mb", std::round(10 * static_cast<double>(usage.ru_maxrss) / 1024) / 10}};
}

Json phase_figures(const PhaseTimes& phase) {
  return {{"read", milli(phase.read)},   {"match", milli(phase.match)},   {"fit", milli(phase.fit)},
          {"close", milli(phase.close)}, {"charts", milli(phase.charts)}, {"write", milli(phase.write)}};
}

Json skipped_json(const std::vector<Skipped>& skipped) {
  Json all = Json::array();
  for (const Skipped& s : skipped) all.push_back({{"reason", s.reason}, {"count", s.count}, {"first", s.first}});
  return all;
}

Json summarise(const MapRun& run, const MapReport& report, const Json& options) {
  const Map& map = run.mapper.map();
  Json json = {{"format", "helicoid-map-summary"}, {"version", HELICOID_VERSION}, {"options", options}};
  json["inputs"] = run.logs;
  Json robots = Json::array();
  for (std::size_t i = 0; i < map.robots().size(); ++i) {
    const RobotRecord& robot = map.robots()[i];
    const bool mapped = !robot.trajectory.empty();
    robots.push_back({{"name", robot.name},
                      {"log", run.logs[i]},
                      {"scans", robot.trajectory.size()},
                      {"island", mapped ? Json(map.island_of(robot.trajectory.front().pose.patch).value) : Json()}});
  }
  json["robots"] = robots;
  add_contents(json, map, report);
  Json closures = {{"open", 0}, {"accepted", 0}, {"rejected", 0}, {"distinct", 0}};
  for (const Hypothesis& h : run.mapper.ledger())
    closures[name_of(h.state)] = closures[name_of(h.state)].get<int>() + 1;
  json["closures"] = closures;
  json["passes"] = run.passes;
  json.update(process_figures(run.wall_seconds()));
  json["scan_us_p50"] = micro(percentile(run.scan_seconds, 0.50));
  json["scan_us_p99"] = micro(percentile(run.scan_seconds, 0.99));
  json["scan_us_by_tenth"] = by_tenth(run.scan_seconds);
  json["phase_cpu_s"] = phase_figures(run.phase);
  json["skipped"] = skipped_json(run.skipped);
  json["warnings"] = run.warnings;
  json["lasers"] = run.lasers;
  return json;
}

}  // namespace helicoid
