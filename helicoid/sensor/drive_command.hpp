// What a robot is told to do with its wheels.
#pragma once

namespace helicoid {

/// Of a differential-drive robot; held until the next one.
struct DriveCommand {
  double speed = 0;      ///< forward, metres a second
  double turn_rate = 0;  ///< anticlockwise, radians a second
  friend bool operator==(const DriveCommand&, const DriveCommand&) = default;
};

}  // namespace helicoid
