// One estimate of a team without lasers from its recorded folder, with the clock kept.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "apps/map_run.hpp"
#include "helicoid/eval/team_error.hpp"
#include "helicoid/io/mrclam_reader.hpp"
#include "helicoid/mapping/fit_team.hpp"

namespace helicoid {

/// Robots and landmarks in one frame.
struct TeamIsland {
  std::vector<std::size_t> robots;  ///< places in the log
  std::vector<std::size_t> landmarks;
  Pose2 T_fit_island;  ///< the first pose of its first robot
};

struct TeamRun {
  MrclamFolder folder;
  TeamFit fit;
  std::vector<TeamIsland> islands;                     ///< that hold robots, the one with most of them first
  std::vector<std::vector<StampedPose>> trajectories;  ///< by robot, ten poses a second, in its island's frame
  bool interrupted = false;
  PhaseTimes phase;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

  /// The island of a robot or landmark, by place in `islands`; none of a landmark that nobody saw.
  [[nodiscard]] std::optional<std::size_t> island_of_robot(std::size_t robot) const;
  [[nodiscard]] std::optional<std::size_t> island_of_landmark(std::size_t landmark) const;
  /// A node's pose in its island's frame.
  [[nodiscard]] Pose2 pose_of(std::uint32_t node) const;
};

/// Error: the folder cannot be read.
[[nodiscard]] Result<TeamRun> run_team(const std::string& folder, const TeamFitOptions& options,
                                       const std::function<void(double)>& progress);

/// Ten poses a second against the folder's truth, in the frame of the fit.
[[nodiscard]] TeamError score_team(const MrclamFolder& folder, const TeamFit& fit);

}  // namespace helicoid
