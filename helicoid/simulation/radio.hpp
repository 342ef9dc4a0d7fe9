// Robots tell what they see by radio. Who has no contact keeps it until there is some again: it comes late and in bulk.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "helicoid/simulation/live_simulation.hpp"

namespace helicoid {

/// A time in which robots have no contact, whatever the building.
struct RadioCut {
  double from = 0, to = 0;          ///< seconds, as LiveSimulation::now(); `to` is outside
  std::vector<std::size_t> robots;  ///< empty: all
};

struct RadioOptions {
  double range = std::numeric_limits<double>::infinity();  ///< in the open, metres
  double wall_loss = 0;                                    ///< of range, at each face of a wall in between; metres
  Vector2d p_world_base = Vector2d::Zero();                ///< who listens stands here
  std::vector<RadioCut> cuts;
};

/// Contact goes from robot to robot, as many hops as it takes; dead robots pass nothing on.
class Radio {
 public:
  Radio(const World& world, std::size_t robots, RadioOptions options);

  /// A tick's events go in; out comes what arrives now: robot by robot, each robot's in its own order.
  [[nodiscard]] std::vector<LiveEvent> pass(std::vector<LiveEvent> events, const LiveSimulation& simulation);
  /// All that still waits, as when robots come home and the memories of dead ones are read.
  [[nodiscard]] std::vector<LiveEvent> hand_over();

  /// At the last pass().
  [[nodiscard]] bool in_contact(std::size_t robot) const { return in_contact_[robot]; }
  [[nodiscard]] std::size_t waiting(std::size_t robot) const { return waiting_[robot].size(); }
  /// Robot-seconds without contact of living robots so far, by robot.
  [[nodiscard]] double cut_seconds(std::size_t robot) const { return cut_seconds_[robot]; }

 private:
  [[nodiscard]] bool reaches(const Vector2d& from, const Vector2d& to) const;
  [[nodiscard]] bool is_cut(std::size_t robot, double now) const;
  void find_contacts(const LiveSimulation& simulation);

  RadioOptions options_;
  RayCaster walls_;
  std::vector<std::vector<LiveEvent>> waiting_;  ///< by robot
  std::vector<bool> in_contact_;
  std::vector<double> cut_seconds_;
  double last_ = 0;  ///< pass(), seconds
};

}  // namespace helicoid
