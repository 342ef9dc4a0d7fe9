// A team's log as a graph of relations (III-B): odometry between a robot's poses, detections from pose to landmark or
// to another robot's pose at that time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/fit/relation_graph.hpp"
#include "helicoid/mapping/commanded_motion.hpp"
#include "helicoid/sensor/team_log.hpp"

namespace helicoid {

/// The nodes of the graph: a pose of a robot at each stamp at which it sees or is seen, and in between where that
/// leaves it alone for long; robot by robot, in order of time. Then the landmarks.
class TeamNodes {
 public:
  /// `gap`: between a robot's consecutive poses at most, seconds. `landmarks`: false leaves them out.
  TeamNodes(const TeamLog& log, double gap, bool landmarks);

  [[nodiscard]] std::uint32_t count() const { return landmark_end_; }
  [[nodiscard]] std::size_t robots() const { return stamps_.size(); }
  [[nodiscard]] std::uint32_t first_of(std::size_t robot) const { return first_[robot]; }
  [[nodiscard]] std::span<const double> stamps_of(std::size_t robot) const { return stamps_[robot]; }
  [[nodiscard]] std::uint32_t first_landmark() const { return first_.back(); }
  [[nodiscard]] bool is_landmark(std::uint32_t node) const { return node >= first_landmark(); }
  /// The robot of a node that is no landmark.
  [[nodiscard]] std::size_t robot_of(std::uint32_t node) const;
  /// The node of a robot's pose at a stamp that has one.
  [[nodiscard]] std::uint32_t at(std::size_t robot, double stamp) const;

 private:
  std::vector<std::vector<double>> stamps_;  ///< by robot
  std::vector<std::uint32_t> first_;         ///< by robot, and of the landmarks
  std::uint32_t landmark_end_ = 0;
};

/// Where a detection stands in the log.
struct DetectionPlace {
  std::uint32_t robot = 0;
  std::uint32_t index = 0;
};

/// The first `odometry` relations join consecutive poses; detections follow, each with its place in the log.
struct TeamGraph {
  RelationGraph graph;
  std::size_t odometry = 0;
  std::vector<DetectionPlace> detections;
  [[nodiscard]] const DetectionPlace& place_of(std::size_t relation) const { return detections[relation - odometry]; }
};

/// The same without these relations, odometry excepted.
[[nodiscard]] TeamGraph without(const TeamGraph& team, const std::vector<bool>& wrong);

/// Detections may be wrong, odometry may not. How precise a range is depends on how far the subject is: by these poses,
/// since what was measured too short must not count for more; as measured if there are none yet.
[[nodiscard]] TeamGraph make_team_graph(const TeamLog& log, const TeamNodes& nodes, const TeamModel& model,
                                        std::span<const Pose2> poses = {});

}  // namespace helicoid
