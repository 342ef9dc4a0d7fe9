// Events as a CARMEN log.
#pragma once

#include <string>

#include "helicoid/sensor/event.hpp"

namespace helicoid {

/// Appends the event's line: FLASER, ODOM, SIGHTING or LOOKALIKE; ranges to the centimetre, poses and stamps to 1e-6.
void append_carmen(std::string& log, const Event& event, const std::string& host);

}  // namespace helicoid
