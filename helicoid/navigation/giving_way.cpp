// The part of the follower that gets out of another's way: two who meet where neither can pass.
#include <algorithm>
#include <numbers>

#include "helicoid/navigation/route_follower.hpp"

namespace helicoid {

namespace {

constexpr double kGotSomewhere = 0.3;       // by odometry, metres
constexpr double kGotSomewhereOnMap = 0.1;  // metres
constexpr double kTrailStep = 0.2;          // metres
constexpr std::size_t kTrailLength = 40;    // steps
constexpr double kRoomToPass = 0.6;         // round a robot that lets another pass, metres
constexpr double kLeastRetreat = 1.2;       // metres
constexpr double kTrailReach = 3.0;         // metres
constexpr double kWaitAside = 6;            // seconds

}  // namespace

void RouteFollower::note_trail(const Map& map, const ManifoldPose& robot) {
  if (giving_way_) return;
  const Pose2 T_plane_robot = map.project(robot);
  if (!trail_.empty()) {
    const ManifoldPose& last = trail_.back().pose;
    const bool same_island = map.island_of(last.patch) == map.island_of(robot.patch);
    if (!same_island) trail_.clear();
    if (same_island && (T_plane_robot.translation() - map.project(last).translation()).norm() < kTrailStep) return;
  }
  trail_.push_back({robot, obstacles_.clearance({0, 0}, 1)});
  if (trail_.size() > kTrailLength) trail_.pop_front();
}

/// By odometry, for a fit may move the robot; and on the map, for wheels slip.
void RouteFollower::note_progress(const Map& map, const ManifoldPose& robot, const Scan& scan, double dt) {
  waiting_ += dt;
  const auto apart = [](const Vector2d& a, const Vector2d& b) { return (a - b).norm(); };
  const Vector2d p_odom = scan.T_odom_robot.translation();
  if (waits_at_ && map.island_of(waits_at_->pose.patch) == map.island_of(robot.patch)) {
    const Vector2d p_plane = map.project(robot).translation();
    if (scan.has_odometry && apart(p_odom, waits_at_->p_odom) < kGotSomewhere) return;
    if (apart(p_plane, map.project(waits_at_->pose).translation()) < kGotSomewhereOnMap) return;
  }
  waits_at_ = {robot, p_odom};
  waiting_ = 0;
}

/// Back to where there is room for two, by the way that the robot came: it is known to be free.
void RouteFollower::give_way(const Map& map, const ManifoldPose& robot) {
  GivingWay giving;
  giving.way.push_back(point_of(robot));
  Vector2d before = map.project(robot).translation();
  double length = 0;
  for (auto at = trail_.rbegin(); at != trail_.rend(); ++at) {
    const Vector2d p = map.project(at->pose).translation();
    length += (p - before).norm();
    before = p;
    giving.way.push_back(point_of(at->pose));
    if (length >= kLeastRetreat && at->room >= kRoomToPass) break;
  }
  waiting_ = 0;
  if (length > kTrailStep) giving_way_ = std::move(giving);
}

/// By the way that it went back.
void RouteFollower::return_to_route() {
  const auto gone = static_cast<std::ptrdiff_t>(giving_way_->cursor.stretch) + 1;
  std::vector<ManifoldPoint> points(giving_way_->way.begin(), giving_way_->way.begin() + gone);
  std::reverse(points.begin(), points.end());
  const auto on = static_cast<std::ptrdiff_t>(std::min(cursor_.stretch + 1, route_.points.size() - 1));
  points.insert(points.end(), route_.points.begin() + on, route_.points.end());
  route_.points = std::move(points);
  cursor_ = {};
  const std::size_t retraced = giving_way_->retraced + giving_way_->cursor.stretch;
  trail_.resize(trail_.size() - std::min(retraced, trail_.size()));
  giving_way_.reset();
}

/// The command while the robot gives way; none if it does not, or not any more.
std::optional<DriveCommand> RouteFollower::step_aside(const Map& map, const ManifoldPose& robot, double dt) {
  if (!giving_way_) return std::nullopt;
  const RouteAhead back = route_ahead(map, giving_way_->way, robot, giving_way_->cursor, kTrailReach);
  giving_way_->cursor = back.cursor;
  const bool is_there = back.left + back.aside < options_.arrived;
  const double turning_round = std::numbers::pi / options_.top_turn_rate;
  if (!is_there && giving_way_->waited == 0 && waiting_ < options_.patience + turning_round) {
    return pursue(back.way, back.left + back.aside);
  }
  // There, or not able to get there: looking at where it wants to go.
  giving_way_->waited += dt;
  waiting_ = 0;
  if (giving_way_->waited > kWaitAside) {
    return_to_route();
    return std::nullopt;
  }
  const RouteAhead ahead = route_ahead(map, route_.points, robot, cursor_, kTrailReach);
  const Vector2d target = point_along(ahead.way, options_.look_ahead).p;
  return turn_to(std::atan2(target.y(), target.x()));
}

}  // namespace helicoid
