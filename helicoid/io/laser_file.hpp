// A laser that the user names: a shipped data sheet, or a file of `key: value` lines.
#pragma once

#include <string>

#include "helicoid/base/result.hpp"
#include "helicoid/sensor/laser_model.hpp"

namespace helicoid {

/// A shipped laser by name, or a text file, laid over the recognised laser. Errors: no such name or file, a broken
/// file.
[[nodiscard]] Result<LaserModel> load_laser(const std::string& name_or_file, const LaserModel& recognised);

/// Lines of `key: value`, `#` comments; metres, radians, seconds, all above 0. Keys: max_range, min_range, range_sigma,
/// kappa, incidence_bias, floor_position, floor_heading, largest_gap, scan_duration; what is not named stays as
/// recognised. Errors: a line that is none of these; `name` is what messages call the file.
[[nodiscard]] Result<LaserModel> parse_laser(const std::string& text, const std::string& name,
                                             const LaserModel& recognised);

}  // namespace helicoid
