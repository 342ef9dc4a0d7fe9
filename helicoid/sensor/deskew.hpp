// Motion within a sweep: a spinning laser measures its beams one after the other while the robot drives on.
#pragma once

#include "helicoid/sensor/event.hpp"
#include "helicoid/sensor/laser_model.hpp"

namespace helicoid {

/// The ranges as the laser would have measured them all at once, where the robot was at the end of the sweep (the last
/// beam), if it moved with this twist (v_x, v_y, omega; metres, radians / second, in its own frame) for the laser's
/// scan_duration. Each return is moved to where it is seen from there; a beam takes the range of the surface between
/// the two moved returns about it, or of the nearer one where they lie on two surfaces. Beams without a return stay as
/// they are. A laser without a scan_duration, or a twist of zero, changes nothing.
[[nodiscard]] Scan deskew(const Scan& scan, const LaserModel& laser, const Vector3d& twist);

}  // namespace helicoid
