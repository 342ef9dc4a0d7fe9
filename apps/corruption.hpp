// Logs with lies in them: to see whether a map believes them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/io/robot_logs.hpp"

namespace helicoid {

struct CorruptionOptions {
  std::size_t false_sightings = 0;
  std::size_t false_lookalikes = 0;
  double unidentified = 0;  ///< share of the false sightings that do not say of whom they are, 0..1
  std::uint64_t seed = 1;
};

/// A false statement as it was put into a log.
struct Lie {
  std::string robot;  ///< in whose log
  double stamp = 0;
  std::string line;  ///< the message
};

struct Corruption {
  std::vector<RobotLogs> robots;  ///< the logs that were written
  std::vector<Lie> lies;          ///< by robot, in the order of its log
  std::size_t true_sightings = 0;
};

/// Copies the logs into the folder, as NAME.clf.gz, with false SIGHTING and LOOKALIKE messages after scans that are
/// drawn at random: a robot that is not there, at any range, bearing and heading that a fiducial could be seen at; a
/// place of any robot's way that is another one. All is said as surely as in truth. Errors: a log cannot be read or
/// holds no scan; false statements of one robot alone were asked for; the folder cannot be written.
[[nodiscard]] Result<Corruption> corrupt_logs(const std::vector<RobotLogs>& robots, const CorruptionOptions& options,
                                              const std::string& folder);

}  // namespace helicoid
