#include "apps/corruption.hpp"

#include <algorithm>
#include <numbers>

#include "helicoid/base/random.hpp"
#include "helicoid/io/gzip_file.hpp"
#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace {

constexpr double kNearest = 0.5;                    ///< metres
constexpr double kFarthest = 8;                     ///< metres
constexpr const char* kSure = "0.030 0.010 0.030";  ///< standard deviations of range, bearing, orientation
constexpr const char* kSurePlace = "0.100 0.030";   ///< of position and heading

/// A robot's log by lines, and which of them are scans.
struct Lines {
  std::vector<std::string> lines;
  std::vector<std::size_t> scans;
  std::vector<double> stamps;  ///< of the scans
  std::size_t sightings = 0;
};

/// The third field from the end: ipc time, host, logger time.
double ipc_time(const std::string& line) {
  std::size_t end = line.find_last_not_of(" \t\r");
  for (int field = 0; field < 2 && end != std::string::npos; ++field) {
    end = line.find_last_of(' ', end);
    end = end == std::string::npos ? end : line.find_last_not_of(' ', end);
  }
  if (end == std::string::npos) return 0;
  const std::size_t begin = line.find_last_of(' ', end);
  return std::atof(line.substr(begin == std::string::npos ? 0 : begin + 1, end - begin).c_str());
}

Result<Lines> read_lines(const RobotLogs& robot) {
  Lines result;
  for (const std::string& path : robot.paths) {
    const Result<TextFile> file = read_text_file(path);
    if (!file) return tl::unexpected(file.error());
    for (std::size_t at = 0; at < file->text.size();) {
      const std::size_t end = std::min(file->text.find('\n', at), file->text.size());
      std::string line = file->text.substr(at, end - at);
      at = end + 1;
      if (line.starts_with("SIGHTING ")) ++result.sightings;
      if (line.starts_with("FLASER ") || line.starts_with("ROBOTLASER1 ") || line.starts_with("RAWLASER1 ")) {
        result.scans.push_back(result.lines.size());
        result.stamps.push_back(ipc_time(line));
      }
      result.lines.push_back(std::move(line));
    }
  }
  if (result.scans.empty()) return fail("{}: holds no scan, so there is nothing to lie about", robot.paths.front());
  return result;
}

/// A lie and the scan after which it is told.
struct Told {
  std::size_t robot = 0;
  std::size_t scan = 0;
  Lie lie;
};

Told told_by(const std::vector<RobotLogs>& robots, const std::vector<Lines>& logs, Random& random) {
  Told told;
  told.robot = random.below(robots.size());
  told.scan = random.below(logs[told.robot].scans.size());
  told.lie.robot = robots[told.robot].name;
  told.lie.stamp = logs[told.robot].stamps[told.scan];
  return told;
}

Told false_sighting(const std::vector<RobotLogs>& robots, const std::vector<Lines>& logs, bool identified,
                    Random& random) {
  Told told = told_by(robots, logs, random);
  const std::size_t other = (told.robot + 1 + random.below(robots.size() - 1)) % robots.size();
  const double bearing = random.uniform(-0.5, 0.5) * std::numbers::pi;
  const double orientation = random.uniform(-1, 1) * std::numbers::pi;
  told.lie.line =
      fmt::format("SIGHTING {} {:.4f} {:.5f} {:.5f} {} {:.6f} liar 0", identified ? robots[other].name : "?",
                  random.uniform(kNearest, kFarthest), bearing, orientation, kSure, told.lie.stamp);
  return told;
}

Told false_lookalike(const std::vector<RobotLogs>& robots, const std::vector<Lines>& logs, Random& random) {
  Told told = told_by(robots, logs, random);
  const std::size_t there = random.below(robots.size());
  const double stamp = logs[there].stamps[random.below(logs[there].stamps.size())];
  told.lie.line = fmt::format("LOOKALIKE {} {:.6f} {:.4f} {:.4f} {:.5f} {} {:.6f} liar 0", robots[there].name, stamp,
                              random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-1, 1) * std::numbers::pi,
                              kSurePlace, told.lie.stamp);
  return told;
}

std::string with_lies(const Lines& log, std::size_t robot, const std::vector<Told>& lies) {
  std::string text;
  std::size_t scan = 0;
  auto next = std::find_if(lies.begin(), lies.end(), [&](const Told& t) { return t.robot == robot; });
  for (std::size_t i = 0; i < log.lines.size(); ++i) {
    text += log.lines[i];
    text += '\n';
    if (scan == log.scans.size() || log.scans[scan] != i) continue;
    for (; next != lies.end() && next->robot == robot && next->scan == scan; ++next) text += next->lie.line + '\n';
    ++scan;
  }
  return text;
}

}  // namespace

Result<Corruption> corrupt_logs(const std::vector<RobotLogs>& robots, const CorruptionOptions& options,
                                const std::string& folder) {
  if (options.false_sightings > 0 && robots.size() < 2) {
    return fail("false sightings need two robots at least; {} was named", robots.size());
  }
  std::vector<Lines> logs;
  Corruption result;
  for (const RobotLogs& robot : robots) {
    Result<Lines> lines = read_lines(robot);
    if (!lines) return tl::unexpected(lines.error());
    result.true_sightings += lines->sightings;
    logs.push_back(std::move(*lines));
  }
  Random random(options.seed);
  std::vector<Told> lies;
  const auto nameless = static_cast<std::size_t>(options.unidentified * static_cast<double>(options.false_sightings));
  for (std::size_t i = 0; i < options.false_sightings; ++i) {
    lies.push_back(false_sighting(robots, logs, i >= nameless, random));
  }
  for (std::size_t i = 0; i < options.false_lookalikes; ++i) lies.push_back(false_lookalike(robots, logs, random));
  std::stable_sort(lies.begin(), lies.end(), [](const Told& x, const Told& y) {
    return x.robot != y.robot ? x.robot < y.robot : x.scan < y.scan;
  });
  for (const Told& told : lies) result.lies.push_back(told.lie);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::string path = fmt::format("{}/{}.clf.gz", folder, robots[i].name);
    if (auto done = write_gzip_file(path, with_lies(logs[i], i, lies)); !done) return tl::unexpected(done.error());
    result.robots.push_back({robots[i].name, {path}});
  }
  return result;
}

}  // namespace helicoid
