// What is wrong with real sensors, as options. Defaults are what a SICK LMS200 on a differential-drive robot does.
#pragma once

namespace helicoid {

struct LaserNoise {
  double range_sigma = 0.010;      ///< metres
  double quantum = 0.01;           ///< ranges are rounded to multiples of it; 0: not; metres
  double missing = 0.003;          ///< probability that a beam returns nothing
  double grazing_angle = 0.10;     ///< a surface seen flatter than this swallows half of the beams; radians
  double beam_divergence = 0.008;  ///< full angle; where its edges see different surfaces a range may be mixed; radians
  double mixed = 0.5;              ///< probability that such a beam reports a range between the two
  // What no reading of one sensor averages out: drawn once per robot.
  double range_bias_sigma = 0.008;     ///< metres
  double bearing_scale_sigma = 0.001;  ///< of the beams' spacing, relative
  double material_sigma = 0.020;       ///< of the range, once per surface: bright and dark walls; metres
  // A scan is not taken at an instant, nor quite at the one that its stamp and odometry name.
  double sweep = 0.0133;        ///< first to last beam, about the scan's pose; seconds
  double timing_sigma = 0.015;  ///< seconds
  [[nodiscard]] static LaserNoise none() { return {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}; }
};

struct OdometryNoise {
  double distance_sigma = 0.03;        ///< per square root of a metre, metres
  double turn_sigma = 0.05;            ///< per square root of a radian, radians
  double drift_sigma = 0.02;           ///< turn per square root of a metre driven, radians
  double distance_scale_sigma = 0.02;  ///< drawn once per robot, relative
  double turn_scale_sigma = 0.03;      ///< drawn once per robot, relative
  double drift_bias_sigma = 0.01;      ///< turn per metre driven, drawn once per robot, radians
  double slip_per_metre = 0.01;        ///< how often a wheel slips
  double slip_turn = 0.05;             ///< by how much, radians
  [[nodiscard]] static OdometryNoise none() { return {0, 0, 0, 0, 0, 0, 0, 0}; }
};

/// A fiducial that other robots' cameras see.
struct SightingNoise {
  double range_sigma = 0.03;        ///< metres
  double bearing_sigma = 0.01;      ///< radians
  double orientation_sigma = 0.03;  ///< radians
  [[nodiscard]] static SightingNoise none() { return {0, 0, 0}; }
};

/// All standard deviations and probabilities times `factor`; rounding and the beam's width stay as they are.
[[nodiscard]] LaserNoise scaled(LaserNoise noise, double factor);
[[nodiscard]] OdometryNoise scaled(OdometryNoise noise, double factor);

}  // namespace helicoid
