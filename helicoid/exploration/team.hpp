// Who explores, what each is told, and what an operator says to it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "helicoid/navigation/manifold_point.hpp"

namespace helicoid {

/// One robot as the others know it now.
struct TeamMember {
  RobotId robot;
  ManifoldPose pose;
  bool available = true;  ///< false: dead, out of contact, or not to be told anything
  double battery = 1;     ///< 1 full, 0 empty
  ManifoldPoint home;     ///< where it returns to
};

enum class GoalKind : std::uint8_t {
  stay,
  frontier,
  rendezvous,
  revisit,  ///< across where two parts of the map meet, to close a loop
  home,
  operator_,
};
[[nodiscard]] const char* name_of(GoalKind kind);

/// Where a robot should go. Published, not seized: what the robot makes of it is its own affair.
struct Goal {
  RobotId robot;
  GoalKind kind = GoalKind::stay;
  ManifoldPoint point;
  std::optional<double> heading_patch;  ///< to turn to on arrival, radians, in the point's patch
  std::string reason;                   ///< in words
  std::size_t doubt = 0;                ///< of a rendezvous: Doubt::id
};

enum class OrderKind : std::uint8_t {
  send,    ///< go to the point and wait there until resumed
  pause,   ///< stand still until resumed
  resume,  ///< explore again
  home,    ///< return home and stay until resumed
  forbid,  ///< nobody goes into the region
};

/// What an operator says; in force from then on.
struct Order {
  OrderKind kind = OrderKind::resume;
  RobotId robot;                       ///< invalid: all
  ManifoldPoint point;                 ///< of send; of forbid: its patch is the region's frame
  std::vector<Vector2d> region_patch;  ///< of forbid: an open ring, metres
};

}  // namespace helicoid
