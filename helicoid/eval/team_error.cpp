#include "helicoid/eval/team_error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "helicoid/eval/trajectory_error.hpp"

namespace helicoid {

namespace {

/// Estimates with their truths, robot after robot.
struct Matches {
  std::vector<Vector2d> places, true_places;
  std::vector<double> headings, true_headings;
  std::vector<std::size_t> robots;
};

std::optional<Pose2> true_pose(const TeamTrack& track, double stamp, double gap) {
  const auto after = std::lower_bound(track.true_stamps.begin(), track.true_stamps.end(), stamp);
  if (after == track.true_stamps.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - track.true_stamps.begin());
  const Pose2& b = track.truth[i];
  if (*after == stamp) return b;
  if (i == 0 || *after - *(after - 1) > gap) return std::nullopt;
  const Pose2& a = track.truth[i - 1];
  const double share = (stamp - *(after - 1)) / (*after - *(after - 1));
  return Pose2{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
               wrap_angle(a.yaw + share * wrap_angle(b.yaw - a.yaw))};
}

Matches match(std::span<const TeamTrack> tracks, double gap) {
  Matches all;
  for (std::size_t robot = 0; robot < tracks.size(); ++robot) {
    const TeamTrack& track = tracks[robot];
    for (std::size_t i = 0; i < track.stamps.size(); ++i) {
      const std::optional<Pose2> truth = true_pose(track, track.stamps[i], gap);
      if (!truth) continue;
      all.places.push_back(track.poses[i].translation());
      all.true_places.push_back(truth->translation());
      all.headings.push_back(track.poses[i].yaw);
      all.true_headings.push_back(truth->yaw);
      all.robots.push_back(robot);
    }
  }
  return all;
}

}  // namespace

TeamError team_error(std::span<const TeamTrack> tracks, double gap) {
  const Matches all = match(tracks, gap);
  TeamError error;
  error.matched = all.places.size();
  error.robots_m.assign(tracks.size(), 0);
  if (all.places.empty()) return error;
  error.T_world_plane = align_points(all.places, all.true_places);
  std::vector<double> counts(tracks.size(), 0);
  double squares = 0;
  double turns = 0;
  for (std::size_t i = 0; i < all.places.size(); ++i) {
    const double square = (error.T_world_plane * all.places[i] - all.true_places[i]).squaredNorm();
    squares += square;
    turns += std::pow(wrap_angle(error.T_world_plane.yaw + all.headings[i] - all.true_headings[i]), 2);
    error.robots_m[all.robots[i]] += square;
    counts[all.robots[i]] += 1;
    error.max_m = std::max(error.max_m, std::sqrt(square));
  }
  const auto count = static_cast<double>(all.places.size());
  error.rms_m = std::sqrt(squares / count);
  error.rms_deg = degrees(std::sqrt(turns / count));
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (counts[i] > 0) error.robots_m[i] = std::sqrt(error.robots_m[i] / counts[i]);
  }
  return error;
}

}  // namespace helicoid
