// Which laser took a log: recognised from the data, or taken from a shipped data sheet.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/sensor/laser_model.hpp"

namespace helicoid {

/// What a message says, or implies, about how its beams lie.
struct BeamLayout {
  int beams = 0;
  double first_bearing = 0;  ///< radians
  double bearing_step = 0;   ///< radians
  friend bool operator==(const BeamLayout&, const BeamLayout&) = default;
};

/// CARMEN's FLASER tells only the number of beams: 180 degrees of view, with the last beam one step short of the end
/// for an even number (180, 360) and on it for an odd one (181, 361).
[[nodiscard]] BeamLayout front_laser_layout(int beams);

/// The model of a laser with this layout from a sample of its ranges: the largest range that keeps turning up is its
/// "no return". A known laser brings its data sheet's noise, an unknown one a cautious guess.
[[nodiscard]] LaserModel recognise_laser(const BeamLayout& layout, std::span<const float> ranges);

/// The names of the shipped data sheets: "sick-lms200", "hokuyo-urg", ..., "generic".
[[nodiscard]] std::vector<std::string> shipped_lasers();
[[nodiscard]] bool is_shipped_laser(const std::string& name);
/// The recognised laser with the noise and the limits of a shipped data sheet.
[[nodiscard]] LaserModel shipped_laser(const std::string& name, const LaserModel& recognised);

/// One line for people: "SICK LMS200: 180 beams over 179 deg, 1 deg apart, no return from 81.83 m".
[[nodiscard]] std::string describe(const LaserModel& laser);

}  // namespace helicoid
