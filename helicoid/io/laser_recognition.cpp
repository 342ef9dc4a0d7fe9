#include "helicoid/io/laser_recognition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

namespace {

/// A data sheet: how the laser is told, and its noise.
struct DataSheet {
  const char* key;
  const char* name;
  double no_return_low, no_return_high;  ///< its "no return" lies between, metres
  double max_range;                      ///< if no "no return" was seen, metres
  double min_range, range_sigma;         ///< metres
};

constexpr DataSheet kSheets[] = {
    {"sick-lms200", "SICK LMS200", 81.5, 82.0, 81.0, 0.05, 0.010},
    {"sick-lms200-50m", "SICK LMS200, 50 m", 49.9, 51.2, 49.9, 0.05, 0.010},
    {"sick-lms200-8m", "SICK LMS200, 8 m", 8.1, 8.2, 8.1, 0.05, 0.010},
    {"hokuyo-urg", "Hokuyo URG-04LX", 4.05, 5.7, 4.0, 0.06, 0.015},
    {"hokuyo-utm30lx", "Hokuyo UTM-30LX", 29.9, 60.1, 29.9, 0.10, 0.015},
};
constexpr DataSheet kGeneric = {"generic", "unknown laser", 0, 0, 80, 0.05, 0.02};

void apply(const DataSheet& sheet, LaserModel& laser) {
  laser.name = sheet.name;
  laser.min_range = sheet.min_range;
  laser.range_sigma = sheet.range_sigma;
}

/// The largest range, if it turns up so often that it is a code and not a measurement; 0 if not.
float find_no_return(std::span<const float> ranges) {
  float largest = 0;
  for (const float r : ranges) {
    if (std::isfinite(r)) largest = std::max(largest, r);
  }
  const auto same = std::count(ranges.begin(), ranges.end(), largest);
  const auto near =
      std::count_if(ranges.begin(), ranges.end(), [=](float r) { return r < largest && r > 0.98F * largest; });
  return same >= 5 && same > 2 * near ? largest : 0;
}

}  // namespace

BeamLayout front_laser_layout(int beams) {
  const int steps = std::max(1, beams % 2 == 0 ? beams : beams - 1);
  return {beams, -0.5 * std::numbers::pi, std::numbers::pi / steps};
}

LaserModel recognise_laser(const BeamLayout& layout, std::span<const float> ranges) {
  LaserModel laser;
  apply(kGeneric, laser);
  laser.beams = layout.beams;
  laser.first_bearing = layout.first_bearing;
  laser.bearing_step = layout.bearing_step;
  const float no_return = find_no_return(ranges);
  float largest = 0;
  for (const float r : ranges) {
    if (std::isfinite(r)) largest = std::max(largest, r);
  }
  // Without a code all that is known is that nothing farther was measured.
  laser.max_range = no_return > 0 ? 0.999 * static_cast<double>(no_return)
                                  : std::max(kGeneric.max_range, 1.01 * static_cast<double>(largest));
  for (const DataSheet& sheet : kSheets) {
    if (no_return >= static_cast<float>(sheet.no_return_low) && no_return <= static_cast<float>(sheet.no_return_high)) {
      apply(sheet, laser);
      break;
    }
  }
  return laser;
}

bool is_shipped_laser(const std::string& name) {
  return name == kGeneric.key ||
         std::any_of(std::begin(kSheets), std::end(kSheets), [&](const DataSheet& sheet) { return name == sheet.key; });
}

LaserModel shipped_laser(const std::string& name, const LaserModel& recognised) {
  LaserModel laser = recognised;
  if (name == kGeneric.key) apply(kGeneric, laser);
  for (const DataSheet& sheet : kSheets) {
    if (name != sheet.key) continue;
    apply(sheet, laser);
    laser.max_range = sheet.max_range;
  }
  return laser;
}

std::vector<std::string> shipped_lasers() {
  std::vector<std::string> names;
  for (const DataSheet& sheet : kSheets) names.emplace_back(sheet.key);
  names.emplace_back(kGeneric.key);
  return names;
}

std::string describe(const LaserModel& laser) {
  return fmt::format("{}: {} beams over {:.4g} deg, {:.4g} deg apart, no return from {:.2f} m", laser.name, laser.beams,
                     degrees(laser.field_of_view()), degrees(laser.bearing_step), laser.max_range);
}

}  // namespace helicoid
