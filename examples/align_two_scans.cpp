// Two scans of one room, taken 12 cm and 3 degrees apart: how did the robot move?
#include <algorithm>
#include <cstdio>
#include <vector>

#include "helicoid/align/align_scan.hpp"

using namespace helicoid;

/// What a laser at this pose sees of a room of 6 m by 4 m whose centre is the origin.
Scan scan_room(const Pose2& T_room_robot, const LaserModel& laser) {
  Scan scan;
  for (int beam = 0; beam < laser.beams; ++beam) {
    const double bearing = T_room_robot.yaw + laser.bearing(beam);
    const double to_side = (std::copysign(3.0, std::cos(bearing)) - T_room_robot.x) / std::cos(bearing);
    const double to_end = (std::copysign(2.0, std::sin(bearing)) - T_room_robot.y) / std::sin(bearing);
    scan.ranges.push_back(static_cast<float>(std::min(to_side, to_end)));
  }
  return scan;
}

int main() {
  LaserModel laser;
  laser.beams = 181;
  laser.first_bearing = radians(-90);
  laser.bearing_step = radians(1);
  const Pose2 T_room_first{0.3, -0.2, 0.4};
  const Pose2 T_first_second{0.12, 0.03, radians(3)};
  ScanPointExtractor first(laser);
  ScanPointExtractor second(laser);

  Reference reference;
  reference.build(std::vector<ReferencePart>{{&first.extract(scan_room(T_room_first, laser)), Pose2{}}});
  PosePrior prior;  // no idea of the motion: "as before", within some 0.3 m and 0.1 rad
  prior.information = Vector3d(10, 10, 100).asDiagonal();
  const Alignment found = align_scan(reference, second.extract(scan_room(T_room_first * T_first_second, laser)), prior);

  std::printf("%s: %.3f m %.3f m %.2f deg\n", name_of(found.status), found.T_reference_scan.x, found.T_reference_scan.y,
              degrees(found.T_reference_scan.yaw));
  return found.usable() && (found.T_reference_scan.inverse() * T_first_second).distance() < 0.01 ? 0 : 1;
}
