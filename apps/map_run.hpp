// One run of the mapper over recorded logs, with the clock kept.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/io/robot_logs.hpp"
#include "helicoid/mapping/mapper.hpp"

namespace helicoid {

struct MapJob {
  std::vector<RobotLogs> robots;
  std::string laser;       ///< a shipped model's name or a file; empty: as recognised
  double laser_noise = 1;  ///< times what the laser is taken to have, all kinds of its noise
  std::size_t every = 1;   ///< only every n-th scan of a robot
  double from = 0;         ///< seconds since the robot's first stamp
  double to = 1e300;
  MapperOptions mapper;
  bool sightings = true;  ///< false: the logs' sightings are left out
  /// Called now and then with the share of events that are done, 0..1.
  std::function<void(double)> progress;
};

/// CPU seconds by phase.
struct PhaseTimes {
  double read = 0, match = 0, fit = 0, close = 0, charts = 0, write = 0;
};

struct MapRun {
  Mapper mapper;
  std::vector<std::string> logs;    ///< by robot: its files, joined by commas
  std::vector<std::string> lasers;  ///< by robot, in words
  std::vector<std::string> warnings;
  std::vector<Skipped> skipped;
  std::vector<double> scan_seconds;  ///< thread CPU time of each scan, its reading included, in order
  std::size_t scans = 0;
  std::size_t passes = 0;  ///< over the logs: more than one if something was believed at first and undone
  bool interrupted = false;
  PhaseTimes phase;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
  [[nodiscard]] double wall_seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  }
};

/// Reads, maps and fits, once more where the finished map contradicts what was believed on the way. Ctrl-C ends the
/// reading; what was mapped until then is kept.
[[nodiscard]] Result<MapRun> run_map(const MapJob& job);

/// What the mapper survived or left out, in words.
[[nodiscard]] std::vector<Skipped> skipped_by(const Mapper& mapper);

/// CPU seconds of this thread so far.
[[nodiscard]] double thread_cpu_seconds();

}  // namespace helicoid
