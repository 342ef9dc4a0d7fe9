// A differential-drive robot that follows a route: what it truly does.
#pragma once

#include "helicoid/simulation/world.hpp"

namespace helicoid {

struct DriveLimits {
  double speed = 0.6;          ///< metres / second
  double turn_rate = 0.8;      ///< radians / second
  double look_ahead = 0.35;    ///< metres
  double turn_in_place = 0.6;  ///< a target farther to the side than this is turned to on the spot, radians
};

/// Drives a route lap after lap: a closed one round and round, an open one out and back.
class RouteDriver {
 public:
  /// Starts on the route at this share of its length; `backward` drives a closed route the other way.
  RouteDriver(Route route, double share, bool backward, const DriveLimits& limits = {});

  /// Moves on by dt seconds, towards a target that lies `aside` metres to the right of the route.
  void step(double dt, double aside = 0);
  /// The target that lies so far to the right of the route.
  [[nodiscard]] Vector2d target(double aside = 0) const;
  [[nodiscard]] const Pose2& T_world_robot() const { return T_world_robot_; }
  /// Finished laps; a lap of an open route is out and back.
  [[nodiscard]] int laps() const { return laps_; }
  [[nodiscard]] double laps_driven() const { return (at_ - start_) / along_.back(); }

 private:
  [[nodiscard]] Vector2d point_at(double along) const;
  [[nodiscard]] double next_corner(double along) const;
  void push_target(double aside);
  std::vector<Vector2d> points_;  ///< a whole lap, the first point again at the end
  std::vector<double> along_;     ///< length up to each point
  std::vector<double> corners_;   ///< lengths up to the sharp bends, ascending, in (0, length]
  double at_ = 0;                 ///< how far along the lap the target has been pushed
  double corner_ = 0;             ///< where the next sharp bend is
  double start_ = 0;
  int laps_ = 0;
  DriveLimits limits_;
  Pose2 T_world_robot_;
};

}  // namespace helicoid
