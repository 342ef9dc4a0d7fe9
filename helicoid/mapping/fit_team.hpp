// A team without lasers, all at once: every robot's way and every landmark's place, most likely given velocities and
// detections (III-C), with robots that are not known beforehand and marks that may be taken for others.
#pragma once

#include <functional>

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/mapping/team_graph.hpp"
#include "helicoid/mapping/team_start.hpp"

namespace helicoid {

struct TeamFitOptions {
  bool landmarks = true;  ///< false: only what robots see of each other counts
  double gap = 0.5;       ///< seconds between a robot's poses at most
  double gate = 4;        ///< sigmas by which a detection may be off and still be of what it says
  double still = 0.02;    ///< metres, RMS: when a round moves the poses by less, the robots are known well enough
  int most_rounds = 20;
  TeamStartOptions start;
};

struct TeamFit {
  TeamNodes nodes;
  TeamGraph team;   ///< as fitted last, without the wrong detections; its poses are the result
  TeamModel model;  ///< that it was fitted with
  FitResult result;
  std::vector<Pose2> start;  ///< where the fits began: the same graph can be fitted from there by others
  int rounds = 0;
  bool is_still = false;                 ///< false: the rounds did not suffice
  std::size_t detections = 0;            ///< that could be used
  std::size_t wrong = 0;                 ///< of these, let go
  std::vector<std::uint32_t> island_of;  ///< by node: what relations tie together, numbered from 0
};

/// Starts, fits, learns how the robots drive and see, lets wrong detections go, and fits again until nothing moves.
/// `progress` is told the share that is done; false ends the rounds.
[[nodiscard]] TeamFit fit_team(const TeamLog& log, const TeamFitOptions& options = {},
                               const std::function<bool(double)>& progress = {});

/// A robot's poses at these stamps, ascending: dead reckoning from the fitted pose before, led evenly to the one after.
/// Stamps before the robot's first or after its last pose are not answered.
struct StampedEstimate {
  double stamp = 0;  ///< seconds
  Pose2 pose;        ///< T_island_robot
};
[[nodiscard]] std::vector<StampedEstimate> poses_at(const TeamLog& log, const TeamFit& fit, std::size_t robot,
                                                    std::span<const double> stamps);

/// The multiples of the period, seconds, at which a robot has poses.
[[nodiscard]] std::vector<double> steady_stamps(const TeamFit& fit, std::size_t robot, double period);

}  // namespace helicoid
