// What a planar laser is: its beams, its limits and its noise. One data sheet serves every log of that laser.
#pragma once

#include <string>
#include <vector>

namespace helicoid {

/// A planar laser with equally spaced beams. Beam i points at `first_bearing + i * bearing_step` in the laser's frame.
struct LaserModel {
  std::string name = "unknown";
  int beams = 0;
  double first_bearing = 0;   ///< radians
  double bearing_step = 0;    ///< radians, anticlockwise positive
  double max_range = 80;      ///< a range at or above it is "no return"; metres
  double min_range = 0.05;    ///< a range below it is no measurement; metres
  double range_sigma = 0.01;  ///< standard deviation of a range, rounding included; metres
  /// How many beams carry the information of one independent beam: a pair's information is M / kappa (design 5.3).
  double kappa = 6;
  /// Systematic error of a range that changes with how a surface is met (footprint, reflectance): metres between a beam
  /// that meets it head on and one that grazes it.
  double incidence_bias = 0.03;
  double floor_position = 0.008;  ///< noise that all beams of a scan share, once per scan: metres
  double floor_heading = 0.0060;  ///< the same, of the heading: radians
  /// Beams farther apart than this do not vouch for the space between them; metres.
  double largest_gap = 0.25;
  /// From the first beam to the last, seconds; 0: the sweep is taken as one moment (see deskew.hpp).
  double scan_duration = 0;

  [[nodiscard]] double bearing(int beam) const { return first_bearing + beam * bearing_step; }
  /// first to last beam, radians
  [[nodiscard]] double field_of_view() const { return (beams - 1) * bearing_step; }
  friend bool operator==(const LaserModel&, const LaserModel&) = default;
};

/// Unit vectors along the beams, tabled once per laser.
struct BeamTable {
  std::vector<float> cosine;
  std::vector<float> sine;
};
[[nodiscard]] BeamTable make_beam_table(const LaserModel& laser);

}  // namespace helicoid
