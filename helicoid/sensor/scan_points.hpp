// From ranges to points with normals, in the robot's frame. Arrays of floats: the compiler vectorises over them.
#pragma once

#include <cstdint>
#include <vector>

#include "helicoid/sensor/event.hpp"
#include "helicoid/sensor/laser_model.hpp"

namespace helicoid {

/// Points on surfaces, each with the unit normal that faces the laser. Structure of arrays, all of one length.
struct ScanPoints {
  std::vector<float> x, y;    ///< metres, in the robot's frame
  std::vector<float> nx, ny;  ///< unit normal, towards the laser
  std::vector<float> weight;  ///< 0..1: how much of an independent measurement the point is; 0 = no trustworthy normal
  std::vector<float> facing;  ///< cosine of the angle between the normal and the way to the laser: 1 = met head on
  std::vector<std::uint16_t> beam;  ///< which beam it came from

  [[nodiscard]] std::size_t size() const { return x.size(); }
  void resize(std::size_t count);
};

/// True if this range is a measurement of a surface.
[[nodiscard]] inline bool is_return(float range, const LaserModel& laser) {
  // NaN fails both comparisons.
  return range >= static_cast<float>(laser.min_range) && range < static_cast<float>(laser.max_range);
}

/// Sums of coordinates and their products over the points before an index: the moments of any run of points in O(1).
/// In double, since moments are differences of large sums.
struct PrefixMoments {
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  [[nodiscard]] PrefixMoments plus(double px, double py) const {
    return {x + px, y + py, xx + px * px, xy + px * py, yy + py * py};
  }
};

/// The second moments, about their mean, of the points that support each point; 0 where there are fewer than three.
struct SupportMoments {
  std::vector<float> xx, xy, yy;  ///< m^2
  void resize(std::size_t count);
};

/// Turns scans of one laser into points; keeps its tables and buffers between scans, so that no scan allocates.
class ScanPointExtractor {
 public:
  explicit ScanPointExtractor(const LaserModel& laser);
  /// The points of a scan; valid until the next call.
  const ScanPoints& extract(const Scan& scan);
  [[nodiscard]] const LaserModel& laser() const { return laser_; }
  [[nodiscard]] const BeamTable& beams() const { return table_; }

 private:
  void find_support();
  void find_normals(float laser_x, float laser_y);

  LaserModel laser_;
  BeamTable table_;
  ScanPoints points_;
  std::vector<float> spacing_;  ///< between neighbouring beams at a point's range, metres
  std::vector<PrefixMoments> prefix_;
  SupportMoments moments_;
};

}  // namespace helicoid
