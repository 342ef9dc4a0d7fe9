// Robots that were seen a moment ago stand in the next scans, too: they are no part of the building (paper IV).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "helicoid/sensor/event.hpp"
#include "helicoid/sensor/laser_model.hpp"

namespace helicoid {

struct SeenRobotsOptions {
  double body = 0.45;        ///< no part of a robot is farther from its centre, metres
  double uncertainty = 0.2;  ///< how much farther it may be for each second since it was seen, metres
  double memory = 1.2;       ///< seconds that a sighting serves
  double fastest = 2;        ///< metres a second
};

/// A scan without what another robot returned.
struct ClearedScan {
  Scan scan;
  std::size_t removed = 0;  ///< returns
};

/// What one robot saw of others, in its own odometry's frame.
class SeenRobots {
 public:
  explicit SeenRobots(const SeenRobotsOptions& options = {}) : options_(options) {}

  /// A sighting without range or bearing tells no place and is passed over. `T_odom_robot`: of the observer then.
  void see(const Pose2& T_odom_robot, double stamp, const Sighting& sighting);

  /// Nothing if no robot is expected in the scan. Another that was seen twice is expected where it went on to.
  [[nodiscard]] std::optional<ClearedScan> clear(const Scan& scan, double stamp, const LaserModel& laser) const;

 private:
  struct Seen {
    std::string name;
    double stamp = 0;
    Vector2d p_odom{0, 0};
    Vector2d velocity{0, 0};  ///< in the odometry's frame, metres a second
  };
  SeenRobotsOptions options_;
  std::vector<Seen> seen_;  ///< the last sighting of each name
};

}  // namespace helicoid
