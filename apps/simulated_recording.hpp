// What simulated robots reported and where they truly were, as `simulate` and `explore` write it.
#pragma once

#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/sensor/event.hpp"
#include "helicoid/simulation/true_relations.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

class SimulatedRecording {
 public:
  /// `maker`: the verb, for the logs' first line.
  SimulatedRecording(std::size_t robots, const std::string& maker);

  void note(const Event& event, const Pose2& T_world_robot);

  [[nodiscard]] const std::vector<TrueTrack>& tracks() const { return tracks_; }
  [[nodiscard]] std::size_t scans() const { return scans_; }
  [[nodiscard]] std::size_t odometry() const { return odometry_; }
  [[nodiscard]] std::size_t sightings() const { return sightings_; }
  [[nodiscard]] double seconds() const { return last_ - first_; }
  [[nodiscard]] double metres() const { return metres_; }

  /// ROBOT.clf.gz, truth/ROBOT.tum, world.yaml and world.svg. Logs of an earlier run with more robots are removed.
  [[nodiscard]] Result<void> write(const World& world, const std::string& folder) const;

 private:
  std::vector<std::string> logs_;
  std::vector<TrueTrack> tracks_;
  std::size_t scans_ = 0, odometry_ = 0, sightings_ = 0;
  double first_ = 0, last_ = 0;  ///< seconds
  bool begun_ = false;
  double metres_ = 0;
};

}  // namespace helicoid
