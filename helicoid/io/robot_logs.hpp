// Several robots' logs as one stream of events (contract: *Robots, order, time*).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "helicoid/io/carmen_reader.hpp"

namespace helicoid {

/// One robot and its logs, in their order.
struct RobotLogs {
  std::string name;
  std::vector<std::string> paths;
};

/// What was named on a command line: plain logs, each a robot of its own, named by its base name up to the first dot;
/// and NAME=LOG[,LOG...]. Errors: an impossible name, two robots of one name.
[[nodiscard]] Result<std::vector<RobotLogs>> name_robots(std::span<const std::string> logs,
                                                         std::span<const std::string> named);

/// Within a robot the order of its files; between robots by (running maximum of that robot's stamps, name bytewise,
/// position in its file).
class MergedLogs {
 public:
  /// Opens all logs, sorted by name; a robot's id is its place. Errors: a log that cannot be read, is empty or binary,
  /// or holds no scan.
  [[nodiscard]] static Result<MergedLogs> open(std::vector<RobotLogs> robots);

  struct Robot {
    RobotLogs logs;
    std::unique_ptr<CarmenReader> reader;
    const Event* head = nullptr;  ///< the robot's next event
    double latest = 0;            ///< running maximum of its stamps
  };
  /// The next event of all, valid until the next call; nullptr at the end.
  const Event* next();
  [[nodiscard]] std::vector<Robot>& robots() { return robots_; }

 private:
  static void advance(Robot& robot);
  std::vector<Robot> robots_;
  Robot* given_ = nullptr;  ///< whose head was handed out last
  bool started_ = false;
};

}  // namespace helicoid
