// A mapper that begins with a map.
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/mapper_state.hpp"

namespace helicoid {

void Mapper::State::go_on_from(Map before) {
  map = std::move(before);
  graph = information_graph(map);
  closer.follow_ways(map);
  patches_at_last_fit = map.patch_count();
  for (const RobotRecord& record : map.robots()) {
    RobotState& robot = robots.emplace_back();
    for (const LaserModel& laser : record.lasers) robot.extractors.emplace_back(laser);
    if (record.trajectory.empty()) continue;
    const TrackedScan last = record.trajectory.back();
    robot.at.pose = last.pose;
    robot.at.covariance = last.covariance;
    robot.last_kept = last.pose.patch;
  }
  // The newest of each robot, if it has one.
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    robots[map.patch(make_id<PatchId>(i)).robot.index()].last_kept = make_id<PatchId>(i);
  }
  for (RobotState& robot : robots) {
    if (!robot.last_kept.valid()) continue;
    robot.since_kept.from = {robot.last_kept, Pose2{}};
    robot.since_kept.T_from_robot = map.express(robot.at.pose, robot.last_kept).T_patch_robot;
    robot.since_known = robot.since_kept;
  }
}

}  // namespace helicoid
