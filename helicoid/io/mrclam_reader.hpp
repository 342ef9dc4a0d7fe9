// The folders of UTIAS's MRCLAM collection (Leung, Halpern, Barfoot and Liu 2011): robots that log velocities and
// measure range and bearing to barcodes, on landmarks and on one another. Files are plain or gzipped.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/io/skipped.hpp"
#include "helicoid/io/trajectory.hpp"
#include "helicoid/sensor/team_log.hpp"

namespace helicoid {

/// A folder's logs, and the truth for whom it may concern.
struct MrclamFolder {
  TeamLog log;                                  ///< robots are robot1 ..., landmarks landmark6 ..., by subject number
  std::vector<std::vector<StampedPose>> truth;  ///< by robot; empty where the folder holds none
  std::map<std::string, Vector2d> landmarks;    ///< true positions by name, as far as the folder has them; metres
  std::vector<Skipped> skipped;
  std::vector<std::string> warnings;
};

/// True of a folder that holds a Barcodes.dat and a RobotN_Odometry.dat.
[[nodiscard]] bool is_mrclam_folder(const std::string& folder);

/// Reads Barcodes, RobotN_Odometry and RobotN_Measurement of every robot, and the Groundtruth files that are there.
/// Lines that tell nothing usable are left out and counted. Errors: a file that is missing, cannot be read or holds
/// nothing.
[[nodiscard]] Result<MrclamFolder> read_mrclam(const std::string& folder);

/// One line of a table with the numbers that its kind of file has; comments and blank lines are none.
struct MrclamRow {
  std::size_t line = 0;  ///< of the file, from 1
  std::vector<double> values;
};
struct MrclamTable {
  std::vector<MrclamRow> rows;
  std::vector<Skipped> skipped;
};
/// Lines of exactly so many finite numbers; others are counted.
[[nodiscard]] MrclamTable parse_mrclam(std::string_view text, std::size_t columns, const std::string& name);

}  // namespace helicoid
