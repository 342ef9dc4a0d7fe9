// Drives a robot along a route, patch by patch: steers in the frames of patches near by, so that no re-fit jerks it,
// and gets round, or out of the way of, what the map does not know.
#pragma once

#include <deque>
#include <optional>

#include "helicoid/navigation/live_obstacles.hpp"
#include "helicoid/navigation/moving_obstacles.hpp"
#include "helicoid/navigation/plan_route.hpp"
#include "helicoid/navigation/route_ahead.hpp"
#include "helicoid/sensor/drive_command.hpp"

namespace helicoid {

struct FollowerOptions {
  double robot_radius = 0.20;    ///< metres
  double margin = 0.025;         ///< kept from everything that the scan shows, metres
  double top_speed = 0.6;        ///< metres a second
  double top_turn_rate = 1.0;    ///< radians a second
  double braking = 0.7;          ///< what is counted on, metres a second squared
  double look_ahead = 0.6;       ///< of the pursuit, metres
  double turn_in_place = 0.7;    ///< a target farther to the side than this is turned to on the spot, radians
  double arrived = 0.10;         ///< this near to the goal is there, metres
  double stands_off = 0.25;      ///< a goal at which there is no room is reached from this near, metres
  double heading_arrived = 0.1;  ///< radians
  double patience = 4;           ///< without getting anywhere until a robot says that it is blocked, seconds
  /// Of robots that wait for one another the one with the largest number gives way first; numbers differ.
  int right_of_way = 0;
};

enum class FollowStatus : std::uint8_t {
  idle,
  driving,
  arrived,
  blocked,  ///< it has got nowhere for a while: plan again, or wait; it keeps trying
};

struct FollowStep {
  DriveCommand command;
  FollowStatus status = FollowStatus::idle;
  double left = 0;                           ///< of the route, metres
  std::optional<ManifoldPoint> obstruction;  ///< on the route, if something stands there now
};

/// One for each robot.
class RouteFollower {
 public:
  explicit RouteFollower(const FollowerOptions& options = {}) : options_(options) {}

  /// From now on this route (found), and at its end turned to this heading, on a patch near there.
  void follow(ManifoldRoute route, std::optional<ManifoldHeading> heading = std::nullopt);
  /// No route any more: idle.
  void stop();
  [[nodiscard]] const ManifoldRoute& route() const { return route_; }

  /// Where the robot stands (on a patch of the map) and what it sees there; `dt` seconds after the last step.
  [[nodiscard]] FollowStep step(const Map& map, const ManifoldPose& robot, const Scan& scan, const LaserModel& laser,
                                double dt);

 private:
  /// Where the robot came from.
  struct Trail {
    ManifoldPose pose;
    double room = 0;  ///< round it, metres
  };
  /// Getting out of the way: back along the trail, then waiting.
  struct GivingWay {
    std::vector<ManifoldPoint> way;
    RouteCursor cursor;
    std::size_t retraced = 0;  ///< places of the trail that it had gone back over where the way now begins
    double waited = 0;         ///< at its end, seconds
  };
  void note_trail(const Map& map, const ManifoldPose& robot);
  void note_progress(const Map& map, const ManifoldPose& robot, const Scan& scan, double dt);
  void give_way(const Map& map, const ManifoldPose& robot);
  void return_to_route();
  [[nodiscard]] double speed_among_movers() const;
  [[nodiscard]] double radius() const { return options_.robot_radius + options_.margin; }
  [[nodiscard]] DriveCommand pursue(std::span<const Vector2d> way, double left);
  [[nodiscard]] DriveCommand turn_to(double bearing);
  [[nodiscard]] DriveCommand drive_to(const Vector2d& target, double left, double wide);
  [[nodiscard]] FollowStep drive(const Map& map, const ManifoldPose& robot);
  [[nodiscard]] bool is_as_near_as_it_gets(const RouteAhead& ahead);
  [[nodiscard]] FollowStep finish(const Map& map, const ManifoldPose& robot, double left);
  [[nodiscard]] std::optional<DriveCommand> step_aside(const Map& map, const ManifoldPose& robot, double dt);
  [[nodiscard]] std::optional<Vector2d> place_to_the_right(std::span<const Vector2d> way) const;
  [[nodiscard]] std::optional<Vector2d> farthest_free(std::span<const Vector2d> way, double wide,
                                                      double shortest) const;
  [[nodiscard]] std::optional<Vector2d> off_what_is_near(std::span<const Vector2d> way) const;
  [[nodiscard]] Vector2d widest_beside(const Vector2d& target) const;
  [[nodiscard]] std::optional<Vector2d> first_barred(std::span<const Vector2d> way) const;

  FollowerOptions options_;
  ManifoldRoute route_;
  std::optional<ManifoldHeading> heading_;
  RouteCursor cursor_;
  LiveObstacles obstacles_;
  MovingObstacles movers_;
  std::deque<Trail> trail_;
  std::optional<GivingWay> giving_way_;
  bool turning_ = false;
  bool near_enough_ = false;  ///< to a goal at which there is no room
  double waiting_ = 0;        ///< since the robot last got anywhere, seconds
  /// Where it was then.
  struct WaitsAt {
    ManifoldPose pose;
    Vector2d p_odom;
  };
  std::optional<WaitsAt> waits_at_;
};

}  // namespace helicoid
