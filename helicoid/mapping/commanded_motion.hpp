// Dead reckoning from the velocities that a robot was told.
#pragma once

#include <span>

#include "helicoid/geometry/pose2.hpp"
#include "helicoid/mapping/team_model.hpp"
#include "helicoid/sensor/team_log.hpp"

namespace helicoid {

/// What was told between two stamps, a delay earlier: metres forward and radians.
struct Commanded {
  double forward = 0;
  double turning = 0;
};

class CommandedMotion {
 public:
  /// The velocities outlive this. Before the first and long after the last of them the robot stands.
  CommandedMotion(std::span<const Velocity> velocities, const OdometryModel& model)
      : velocities_(velocities), model_(model) {}

  /// T_from_to of the robot's poses at two stamps, from <= to: arcs of constant velocity, one after another.
  [[nodiscard]] Pose2 between(double from, double to) const;
  [[nodiscard]] Commanded told(double from, double to) const;

 private:
  template <class Visit>
  void for_each_piece(double from, double to, Visit&& visit) const;

  std::span<const Velocity> velocities_;
  OdometryModel model_;
};

}  // namespace helicoid
