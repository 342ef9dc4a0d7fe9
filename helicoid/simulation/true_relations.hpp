// Pairs of scans whose true relative pose is worth knowing, as Kuemmerle et al. 2009 chose theirs: a moment apart along
// the way, and near one another after a long way or on two robots.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// Where a robot truly was at each of its scans.
struct TrueTrack {
  std::string robot;
  std::vector<double> stamps;  ///< seconds
  std::vector<Pose2> T_world_robot;
};

/// Two scans: places in the list of tracks and in the track.
struct ScanPair {
  std::size_t robot_a = 0, scan_a = 0;
  std::size_t robot_b = 0, scan_b = 0;
  friend auto operator<=>(const ScanPair&, const ScanPair&) = default;
};

struct TrueRelationsOptions {
  double every = 1;           ///< a local pair begins about so often, seconds
  double longest_gap = 4;     ///< of a local pair, seconds
  double revisit_gap = 30;    ///< a robot's scans farther apart in time than this can make a revisit, seconds
  double revisit_near = 2;    ///< and nearer to one another than this, metres
  double meeting_near = 4;    ///< scans of two robots nearer than this make a pair, metres
  std::size_t tries = 20000;  ///< at random pairs of scans, for revisits and for each pair of robots
  std::size_t most = 1000;    ///< revisits a robot, and pairs between two robots
};

/// In ascending order; the same seed, the same pairs.
[[nodiscard]] std::vector<ScanPair> choose_true_relations(std::span<const TrueTrack> tracks, std::uint64_t seed,
                                                          const TrueRelationsOptions& options = {});

}  // namespace helicoid
