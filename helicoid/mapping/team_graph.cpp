#include "helicoid/mapping/team_graph.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// Nothing is seen nearer than this, metres; the bearing of what is would say nothing of the place.
constexpr double kNearest = 0.1;

/// One damaged stamp must not make millions of poses.
constexpr double kMostPieces = 1000;

/// Sorted, each once, and no two farther apart than the gap.
std::vector<double> densified(std::vector<double> stamps, double gap) {
  std::sort(stamps.begin(), stamps.end());
  stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
  std::vector<double> dense;
  for (const double stamp : stamps) {
    const double before = dense.empty() ? stamp : dense.back();
    const auto pieces = static_cast<int>(std::min(kMostPieces, std::ceil((stamp - before) / gap)));
    for (int k = 1; k < pieces; ++k) dense.push_back(before + (stamp - before) * k / pieces);
    dense.push_back(stamp);
  }
  return dense;
}

PosePose odometry_relation(const CommandedMotion& motion, const OdometryModel& model, double from, double to) {
  const double seconds = to - from;
  const double metres = model.forward_gain * model.forward_gain * seconds;
  PosePose relation{motion.between(from, to), Matrix3d::Zero()};
  relation.information.diagonal() << 1 / (model.forward_rate * metres), 1 / (model.sideways_rate * metres),
      1 / model.turning_variance(seconds, motion.told(from, to).turning);
  return relation;
}

/// The place as measured, with the information of range and bearing along and across the line of sight.
PointPosition detection_relation(const Detection& d, const DetectionModel& model, double distance) {
  const Vector2d along(std::cos(d.bearing), std::sin(d.bearing));
  const Vector2d across(-along.y(), along.x());
  const double range_variance = model.range_kappa * model.range_variance(distance);
  const double across_variance = model.bearing_kappa * std::pow(model.bearing_sigma * distance, 2);
  return {d.range * along, along * along.transpose() / range_variance + across * across.transpose() / across_variance};
}

}  // namespace

TeamNodes::TeamNodes(const TeamLog& log, double gap, bool landmarks) : stamps_(log.robots.size()) {
  for (std::size_t i = 0; i < log.robots.size(); ++i) {
    const TeamRobot& robot = log.robots[i];
    if (!robot.velocities.empty()) {
      stamps_[i].push_back(robot.velocities.front().stamp);
      stamps_[i].push_back(robot.velocities.back().stamp);
    }
    for (const Detection& d : robot.detections) {
      if (!landmarks && !log.is_robot(d.subject)) continue;
      stamps_[i].push_back(d.stamp);
      if (log.is_robot(d.subject)) stamps_[d.subject].push_back(d.stamp);
    }
  }
  first_.push_back(0);
  for (auto& stamps : stamps_) {
    stamps = densified(std::move(stamps), gap);
    first_.push_back(first_.back() + static_cast<std::uint32_t>(stamps.size()));
  }
  landmark_end_ = first_.back() + (landmarks ? static_cast<std::uint32_t>(log.landmarks.size()) : 0);
}

std::size_t TeamNodes::robot_of(std::uint32_t node) const {
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), node) - first_.begin()) - 1;
}

std::uint32_t TeamNodes::at(std::size_t robot, double stamp) const {
  const auto& stamps = stamps_[robot];
  return first_[robot] +
         static_cast<std::uint32_t>(std::lower_bound(stamps.begin(), stamps.end(), stamp) - stamps.begin());
}

TeamGraph without(const TeamGraph& team, const std::vector<bool>& wrong) {
  TeamGraph kept;
  kept.graph.poses = team.graph.poses;
  kept.graph.is_landmark = team.graph.is_landmark;
  kept.odometry = team.odometry;
  for (std::size_t i = 0; i < team.graph.relations.size(); ++i) {
    if (i >= team.odometry && wrong[i]) continue;
    kept.graph.relations.push_back(team.graph.relations[i]);
    if (i >= team.odometry) kept.detections.push_back(team.place_of(i));
  }
  return kept;
}

TeamGraph make_team_graph(const TeamLog& log, const TeamNodes& nodes, const TeamModel& model,
                          std::span<const Pose2> poses) {
  TeamGraph team;
  RelationGraph& graph = team.graph;
  graph.poses.assign(poses.begin(), poses.end());
  graph.poses.resize(nodes.count());
  graph.is_landmark.assign(nodes.count(), false);
  std::fill(graph.is_landmark.begin() + nodes.first_landmark(), graph.is_landmark.end(), true);
  for (std::size_t i = 0; i < log.robots.size(); ++i) {
    const CommandedMotion motion(log.robots[i].velocities, model.odometry[i]);
    const std::span<const double> stamps = nodes.stamps_of(i);
    const std::uint32_t first = nodes.first_of(i);
    for (std::uint32_t k = 1; k < stamps.size(); ++k) {
      const PosePose relation = odometry_relation(motion, model.odometry[i], stamps[k - 1], stamps[k]);
      graph.relations.push_back({first + k - 1, first + k, relation, false});
    }
  }
  team.odometry = graph.relations.size();
  for (std::uint32_t i = 0; i < log.robots.size(); ++i) {
    const std::vector<Detection>& detections = log.robots[i].detections;
    for (std::uint32_t k = 0; k < detections.size(); ++k) {
      const Detection& d = detections[k];
      const auto landmark = nodes.first_landmark() + d.subject - static_cast<std::uint32_t>(log.robots.size());
      if (!log.is_robot(d.subject) && landmark >= nodes.count()) continue;
      const std::uint32_t seen = log.is_robot(d.subject) ? nodes.at(d.subject, d.stamp) : landmark;
      const std::uint32_t from = nodes.at(i, d.stamp);
      const double distance = poses.empty() ? d.range : (poses[seen].translation() - poses[from].translation()).norm();
      const auto relation = detection_relation(d, model.detection[i], std::max(kNearest, distance));
      graph.relations.push_back({from, seen, relation, true});
      team.detections.push_back({i, k});
    }
  }
  return team;
}

}  // namespace helicoid
