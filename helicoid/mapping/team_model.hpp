// What robots of a team do when they are told to move, and how well they see: estimated, not known beforehand.
#pragma once

#include <cmath>
#include <vector>

namespace helicoid {

/// Robots do not do quite what they are told. What gains and delay leave over grows with time. Positions are counted in
/// metres told: where gains are not known either, a smaller world must not look more precise.
struct OdometryModel {
  double forward_gain = 1;      ///< metres driven per metre told
  double sideways_gain = 0;     ///< metres to the left per metre told: the heading is where the sensor looks
  double turning_gain = 1;      ///< radians turned per radian told
  double veer = 0;              ///< radians turned per metre told
  double delay = 0;             ///< seconds from telling to doing
  double forward_rate = 0.01;   ///< variance a second, (metres told)^2/s
  double sideways_rate = 1e-3;  ///< (metres told)^2/s
  double turning_rate = 1e-3;   ///< rad^2/s
  double turning_share = 0.05;  ///< and per radian told, rad^2/rad

  [[nodiscard]] double turning_variance(double seconds, double told) const {
    return turning_rate * seconds + turning_share * std::abs(told);
  }
};

/// Variance of a range: floor^2 + (share * range)^2; of a bearing: sigma^2. What is seen again a moment later is seen
/// with much the same error: as with a laser's beams, only every kappa-th detection is independent of the others.
struct DetectionModel {
  double range_floor = 0.1;     ///< metres
  double range_share = 0.05;    ///< of the range
  double bearing_sigma = 0.03;  ///< radians
  double range_kappa = 1;       ///< detections that tell as much of the range as an independent one
  double bearing_kappa = 1;     ///< and of the bearing

  [[nodiscard]] double range_variance(double range) const {
    return range_floor * range_floor + range_share * range_share * range * range;
  }
};

/// By robot. The defaults are where estimating begins: a robot that is hardly known.
struct TeamModel {
  std::vector<OdometryModel> odometry;
  std::vector<DetectionModel> detection;
};

}  // namespace helicoid
