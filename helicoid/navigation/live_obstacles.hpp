// What a robot could touch right now: its latest scan, and for a few seconds what it has just passed, which its laser
// does not see any more.
#pragma once

#include <span>
#include <vector>

#include "helicoid/sensor/event.hpp"
#include "helicoid/sensor/laser_model.hpp"

namespace helicoid {

/// Where a scan's beams met something within `reach` metres of the laser, in order of the beams.
[[nodiscard]] std::vector<Vector2d> surfaces_within(double reach, std::span<const float> ranges,
                                                    const LaserModel& laser, const Pose2& T_frame_laser);

/// All in the robot's frame of the latest scan; what is remembered is carried along by odometry.
class LiveObstacles {
 public:
  /// `dt` seconds after the scan before.
  void see(const Scan& scan, const LaserModel& laser, double dt);

  [[nodiscard]] std::span<const Vector2d> points() const { return points_; }
  /// From a point to the nearest obstacle, metres; infinity beyond `reach`.
  [[nodiscard]] double clearance(const Vector2d& p_robot, double reach) const;
  /// How far a disc of `radius` at the robot can go straight to a point without touching more than it already does,
  /// metres; the whole distance if nothing is in its way.
  [[nodiscard]] double free_way(const Vector2d& p_robot, double radius) const;
  /// The same along an arc of this curvature (1 / m, anticlockwise), up to `reach` metres.
  [[nodiscard]] double free_arc(double curvature, double radius, double reach) const;

 private:
  struct Remembered {
    Vector2d p_odom;
    double age = 0;  ///< seconds
  };
  void remember(const Scan& scan, const LaserModel& laser, double dt);

  std::vector<Vector2d> points_;
  std::vector<Vector2d> in_view_;  ///< of the scan before, odometry's frame
  std::vector<Remembered> remembered_;
};

}  // namespace helicoid
