#include "helicoid/navigation/route_follower.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/navigation/local_detour.hpp"

namespace helicoid {

namespace {

constexpr double kReach = 3.0;      // of the route that is looked at, metres
constexpr double kSlowest = 0.03;   // metres a second
constexpr double kShortest = 0.18;  // look-ahead, metres
// Beyond the margin, where the way leaves room for it: lasers measure dark surfaces some centimetres too far off.
constexpr double kBerth = 0.04;          // metres
constexpr double kShortestBerth = 0.30;  // look-ahead with a berth, metres
constexpr double kLookingStep = 0.08;    // between look-aheads that are tried, metres
constexpr double kTooNear = 0.01;        // beyond the margin, metres
constexpr double kStep = 0.12;           // aside, metres
constexpr double kStepAfter = 1.5;       // without getting anywhere, seconds
constexpr double kStepTurn = 0.2;        // between directions of a step aside, radians
constexpr double kMostStepTurn = 2.0;    // radians
constexpr double kShift = 0.02;          // between places beside a target that are tried, metres
constexpr double kMostShift = 0.15;      // as a share of the way there: a robot turns in little by little
constexpr double kBesideAhead = 0.7;     // metres
constexpr double kMostAside = 0.8;       // metres
constexpr double kMoversAhead = 1.4;     // farther aside nothing is given way to, radians
constexpr double kComesAcross = 0.3;     // sine of the angle between its way and the robot's
constexpr double kStandsClear = 0.35;    // of what has the right of way, metres
constexpr double kTurnGain = 2.5;        // radians a second for a radian
constexpr double kTurnOfYielding = 2;    // between two robots' turns to give way, seconds
constexpr int kTurns = 8;

double bearing_of(const Vector2d& p) {
  return std::atan2(p.y(), p.x());
}

}  // namespace

void RouteFollower::follow(ManifoldRoute route, std::optional<ManifoldHeading> heading) {
  route_ = std::move(route);
  heading_ = heading;
  cursor_ = {};
  near_enough_ = false;
  // The new route begins here: not from where the robot began to go back.
  if (giving_way_) {
    giving_way_->way.erase(giving_way_->way.begin(),
                           giving_way_->way.begin() + static_cast<std::ptrdiff_t>(giving_way_->cursor.stretch));
    giving_way_->retraced += giving_way_->cursor.stretch;
    giving_way_->cursor = {};
  }
}

void RouteFollower::stop() {
  route_ = {};
  giving_way_.reset();
  waiting_ = 0;
}

FollowStep RouteFollower::step(const Map& map, const ManifoldPose& robot, const Scan& scan, const LaserModel& laser,
                               double dt) {
  obstacles_.see(scan, laser, dt);
  movers_.see(scan, laser, dt);
  note_trail(map, robot);
  if (route_.points.empty()) return {};
  note_progress(map, robot, scan, dt);
  if (!giving_way_ && waiting_ > options_.patience + kTurnOfYielding * (kTurns - options_.right_of_way % kTurns)) {
    give_way(map, robot);
  }
  if (const std::optional<DriveCommand> aside = step_aside(map, robot, dt)) {
    const RouteAhead ahead = route_ahead(map, route_.points, robot, cursor_, kReach);
    return {*aside, FollowStatus::blocked, ahead.left, std::nullopt};
  }
  FollowStep step = drive(map, robot);
  if (step.status == FollowStatus::arrived) waiting_ = 0;
  if (step.status == FollowStatus::driving && waiting_ > options_.patience) step.status = FollowStatus::blocked;
  return step;
}

FollowStep RouteFollower::drive(const Map& map, const ManifoldPose& robot) {
  const RouteAhead ahead = route_ahead(map, route_.points, robot, cursor_, kReach);
  cursor_ = ahead.cursor;
  const double to_goal = ahead.left + ahead.aside;
  if (to_goal < options_.arrived || is_as_near_as_it_gets(ahead)) return finish(map, robot, to_goal);
  FollowStep step;
  step.status = FollowStatus::driving;
  step.left = ahead.left;
  if (speed_among_movers() < kSlowest) return step;
  std::vector<Vector2d> way = ahead.way;
  const std::optional<Vector2d> barred = first_barred(way);
  if (barred) step.obstruction = ManifoldPoint{robot.patch, robot.T_patch_robot * *barred};
  // Or right beside the robot: where the map has a gap a little aside of where it is.
  if (barred || !farthest_free(way, radius(), kShortest)) {
    DetourOptions detour;
    detour.radius = radius() + 0.01;
    detour.comfortable = std::max(detour.comfortable, detour.radius + 0.1);
    std::vector<Vector2d> round = find_detour(obstacles_, way, detour);
    if (!round.empty()) {
      way = std::move(round);
    } else if (const std::optional<Vector2d> side = place_to_the_right(way)) {
      step.command = drive_to(*side, to_goal, radius());
      return step;
    }
  }
  step.command = pursue(way, to_goal);
  return step;
}

/// Where something stands at the goal, or at where the map has it, it is reached from beside it.
bool RouteFollower::is_as_near_as_it_gets(const RouteAhead& ahead) {
  const Vector2d& goal = ahead.way.back();
  near_enough_ = (near_enough_ || waiting_ > options_.patience) && goal.norm() < options_.stands_off &&
                 ahead.left < options_.look_ahead && obstacles_.clearance(goal, radius()) < radius();
  return near_enough_;
}

/// Ahead, as far to the right of the way as there is room: where two meet, each makes room for the other.
std::optional<Vector2d> RouteFollower::place_to_the_right(std::span<const Vector2d> way) const {
  const PointAlong from = point_along(way, 0.5 * kBesideAhead);
  const PointAlong to = point_along(way, kBesideAhead);
  const Vector2d along = to.p - from.p;
  if (along.norm() < 0.1) return std::nullopt;
  const Vector2d right = Vector2d(along.y(), -along.x()).normalized();
  for (double aside = kMostAside; aside > 0.05; aside -= 0.05) {
    const Vector2d p = to.p + aside * right;
    if (obstacles_.clearance(p, radius()) < radius()) continue;
    if (obstacles_.free_way(p, radius()) >= p.norm() - 1e-9) return p;
  }
  return std::nullopt;
}

FollowStep RouteFollower::finish(const Map& map, const ManifoldPose& robot, double left) {
  FollowStep step{{}, FollowStatus::arrived, left, std::nullopt};
  if (!heading_) return step;
  const double heading = map.T_plane_patch(heading_->patch).yaw + heading_->heading_patch;
  const double turn = wrap_angle(heading - map.project(robot).yaw);
  if (std::abs(turn) < options_.heading_arrived) return step;
  step.command = turn_to(turn);
  step.status = FollowStatus::driving;
  return step;
}

/// Where the robot would touch something first if it kept to the way.
std::optional<Vector2d> RouteFollower::first_barred(std::span<const Vector2d> way) const {
  const double length = point_along(way, kReach).along;
  for (double along = 0; along <= length; along += kLookingStep) {
    const Vector2d p = point_along(way, along).p;
    if (p.norm() > radius() && obstacles_.clearance(p, radius()) < radius()) return p;
  }
  return std::nullopt;
}

/// The farthest point of the way to which the robot can go straight, so wide from everything.
std::optional<Vector2d> RouteFollower::farthest_free(std::span<const Vector2d> way, double wide,
                                                     double shortest) const {
  for (double along = options_.look_ahead; along >= shortest; along -= kLookingStep) {
    const Vector2d target = point_along(way, along).p;
    if (obstacles_.free_way(target, wide) >= target.norm() - 1e-9) return target;
  }
  return std::nullopt;
}

/// Where the robot stands so near to something that every way on would bring it nearer still: a small step aside, as
/// little as will do, to where there is room.
std::optional<Vector2d> RouteFollower::off_what_is_near(std::span<const Vector2d> way) const {
  if (waiting_ < kStepAfter) return std::nullopt;
  if (obstacles_.clearance({0, 0}, radius() + kTooNear) >= radius() + kTooNear) return std::nullopt;
  const double ahead = bearing_of(point_along(way, kStep).p);
  for (double aside = kStepTurn; aside < kMostStepTurn; aside += kStepTurn) {
    for (const double turn : {-aside, aside}) {
      const Vector2d p = kStep * Vector2d(std::cos(ahead + turn), std::sin(ahead + turn));
      if (obstacles_.clearance(p, 1) < radius() + kTooNear) continue;
      if (obstacles_.free_way(p, radius()) >= p.norm() - 1e-9) return p;
    }
  }
  return std::nullopt;
}

/// Beside a target, where it is widest: what is nearer on one side than on the other may be nearer still.
Vector2d RouteFollower::widest_beside(const Vector2d& target) const {
  const Vector2d left = Vector2d(-target.y(), target.x()).normalized();
  const double enough = radius() + kBerth;
  const auto room_towards = [&](const Vector2d& p) {
    return std::min({enough, obstacles_.clearance(0.5 * p, enough), obstacles_.clearance(p, enough)});
  };
  Vector2d widest = target;
  double room = room_towards(target);
  for (double shift = kShift; shift <= kMostShift * target.norm() && room < enough; shift += kShift) {
    for (const double side : {-shift, shift}) {
      const Vector2d p = target + side * left;
      const double wide = room_towards(p);
      if (wide <= room || obstacles_.free_way(p, radius()) < p.norm() - 1e-9) continue;
      widest = p;
      room = wide;
    }
  }
  return widest;
}

/// What comes across from the right goes first, and what comes from the left waits; it can still stop if that does not.
double RouteFollower::speed_among_movers() const {
  double speed = options_.top_speed;
  for (const MovingObstacle& mover : movers_.all()) {
    if (std::abs(bearing_of(mover.p_robot)) > kMoversAhead) continue;
    const double room = mover.p_robot.norm() - radius();
    const bool known = mover.direction.norm() > 0.5;
    const bool from_the_right = mover.p_robot.y() < 0 && (!known || mover.direction.y() > kComesAcross);
    const double stops_in = from_the_right && waiting_ < options_.patience ? 0.5 * (room - kStandsClear) : room - 0.08;
    speed = std::min(speed, std::sqrt(2 * options_.braking * std::max(0.0, stops_in)));
  }
  return speed;
}

/// Pure pursuit (Coulter 1992).
DriveCommand RouteFollower::pursue(std::span<const Vector2d> way, double left) {
  const double wide = radius() + kBerth;
  if (const auto target = farthest_free(way, wide, kShortestBerth)) return drive_to(*target, left, wide);
  if (const auto target = farthest_free(way, radius(), kShortest)) {
    const DriveCommand command = drive_to(widest_beside(*target), left, radius());
    // Straight there is room, and by the arc that it would drive there is none.
    if (command != DriveCommand{}) return command;
  }
  if (const auto target = off_what_is_near(way)) return drive_to(*target, left, radius());
  // Up to what stands there, looking at it.
  return turn_to(bearing_of(point_along(way, options_.look_ahead).p));
}

DriveCommand RouteFollower::turn_to(double bearing) {
  if (std::abs(bearing) < 0.03) return {};
  return {0, std::clamp(kTurnGain * bearing, -options_.top_turn_rate, options_.top_turn_rate)};
}

/// By an arc that keeps so wide from everything: that to a target aside sets out along the robot's heading, and may
/// come nearer to a wall than the straight way does.
DriveCommand RouteFollower::drive_to(const Vector2d& target, double left, double wide) {
  const double bearing = bearing_of(target);
  turning_ = std::abs(bearing) > (turning_ ? 0.3 * options_.turn_in_place : options_.turn_in_place);
  if (turning_) return turn_to(bearing);
  const double curvature = 2 * std::sin(bearing) / std::max(target.norm(), 0.2);
  const double free = obstacles_.free_arc(curvature, wide, 1.0);
  const double room = obstacles_.clearance({0, 0}, 1) - radius();
  double speed = options_.top_speed * (1 - std::abs(bearing) / (2 * options_.turn_in_place));
  // Whoever comes towards the robot brakes as well: each has half the way.
  speed = std::min(speed, std::sqrt(options_.braking * std::max(0.0, free - 0.08)));
  speed = std::min(speed, 0.05 + std::sqrt(options_.braking * left));
  // Beside the way as well: two that come together must both have stopped before they touch.
  speed = std::min(speed, 0.1 + 2.5 * std::max(room, 0.0));
  if (std::abs(curvature) > 1e-6) speed = std::min(speed, options_.top_turn_rate / std::abs(curvature));
  speed = std::min(speed, speed_among_movers());
  if (speed < kSlowest) return turn_to(bearing);
  return {speed, speed * curvature};
}

}  // namespace helicoid
