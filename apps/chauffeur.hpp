// Drives a simulated robot along a world's route by the truth: exploring, for experiments that begin in the middle of
// it.
#pragma once

#include "helicoid/sensor/drive_command.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

class Chauffeur {
 public:
  /// Lap after lap: a closed route round and round, an open one out and back.
  explicit Chauffeur(const Route& route, double top_speed = 0.6, double top_turn_rate = 1.0);

  /// Where the route begins, looking along it.
  [[nodiscard]] Pose2 T_world_start() const;
  /// Straight from point to point, turning on the spot; the robot stands on the way to the next point.
  [[nodiscard]] DriveCommand command(const Pose2& T_world_robot);

 private:
  std::vector<Vector2d> points_;
  std::size_t next_ = 1;
  double top_speed_, top_turn_rate_;
};

}  // namespace helicoid
