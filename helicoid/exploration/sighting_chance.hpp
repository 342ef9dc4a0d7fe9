// How surely two robots would see each other, if two places were one (paper I: robots arrange a rendezvous at two
// points that may or may not be the same place; if they fail to meet, the points are distinct).
#pragma once

#include <cstdint>
#include <optional>

#include "helicoid/geometry/covariance.hpp"
#include "helicoid/manifold/map.hpp"

namespace helicoid {

/// An open question of the map's: was patch b taken where patch a lies?
struct Doubt {
  std::size_t id = 0;  ///< the asker's number for it
  PatchId a, b;
  UncertainPose2 T_a_b;  ///< where b would lie
  double ambiguity = 1;  ///< 0: no other placement fits; 1: no telling
};

/// What a robot sees of another.
struct SightingModel {
  double range = 8;                         ///< metres
  double field_of_view = std::numbers::pi;  ///< ahead, radians
  double period = 1;                        ///< between looks, seconds
  double reliability = 0.9;                 ///< that a robot in full view is seen at one look
};

/// How well a robot knows where it stands on its own sheet, one sigma.
struct StandingNoise {
  double position = 0.06;  ///< metres
  double heading = 0.03;   ///< radians
};

/// Of the two of a meeting.
struct PairsNoise {
  StandingNoise watcher, shown;
};

/// Beside a patch's place: what a robot does not know on its own sheet, and what the map does not know of where its
/// patch lies from that one. None if the map says nothing of that.
[[nodiscard]] std::optional<StandingNoise> standing_beside(const Map& map, PatchId patch, const ManifoldPose& robot,
                                                           const StandingNoise& on_its_sheet);

/// The chance that the robot at T_a_watcher has the robot at T_b_shown in view, if the doubt's two places are one:
/// within range, ahead, and with nothing that patch a knows between them; over what is uncertain of the poses.
[[nodiscard]] double view_chance(const Map& map, const Doubt& doubt, const Pose2& T_a_watcher, const Pose2& T_b_shown,
                                 const SightingModel& model, const PairsNoise& noise, std::uint64_t seed = 1);

/// The chance that it has seen it at least once after so many looks.
[[nodiscard]] double sighting_chance(double view_chance, const SightingModel& model, int looks);

}  // namespace helicoid
