// Scan to local map, point to line, by iteratively re-weighted Gauss-Newton (paper IV-A steps 3 and 4, EM-style).
#pragma once

#include "helicoid/align/reference.hpp"
#include "helicoid/geometry/pose2.hpp"
#include "helicoid/sensor/laser_model.hpp"
#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

struct AlignOptions {
  double first_gate = 0.25;      ///< pairs farther apart are not considered in the first round, metres
  double last_gate = 0.12;       ///< the same in the last rounds
  double robust_scale = 0.03;    ///< residuals beyond it lose their weight (Geman-McClure), metres
  double range_sigma = 0.012;    ///< of a residual, reference included: the unit of the information, metres
  double incidence_bias = 0.03;  ///< pairs seen at different incidence disagree by this much a unit of cosine, metres
  double kappa = 8;              ///< beams that carry the information of one; divides the information against the prior
  double prior_freedom = 4;      ///< degrees of freedom of the prior's Student t: small = heavy tails
  int max_iterations = 20;
  double min_inlier_share = 0.35;  ///< of the points with a normal; fewer = failure
  int min_points = 12;
};

/// Of a prior's Student t: so many degrees of freedom make it a Gaussian, which does not fade whatever the beams say.
inline constexpr double kGaussian = 1e6;

/// The defaults with what is the laser's own.
[[nodiscard]] AlignOptions align_options(const LaserModel& laser);

/// What odometry says about the pose, as a Gaussian in the reference's frame.
struct PosePrior {
  Pose2 T_reference_scan;
  Matrix3d information = Matrix3d::Zero();
};

enum class AlignStatus : std::uint8_t {
  aligned,
  too_few_points,   ///< the scan has too few points with a normal
  empty_reference,  ///< nothing to align to
  too_few_inliers,  ///< most points lie on no surface of the reference
  degenerate,       ///< aligned, but the surfaces leave a direction open: the prior fills it
  diverged,         ///< left the neighbourhood in which the prior is believable
};
[[nodiscard]] const char* name_of(AlignStatus status);

struct Alignment {
  AlignStatus status = AlignStatus::too_few_points;
  Pose2 T_reference_scan;
  /// Gauss-Newton information of (x, y, yaw) from the beams alone, all beams taken as independent: not divided by
  /// kappa, prior left out. Singular in a corridor.
  Matrix3d information = Matrix3d::Zero();
  double inlier_share = 0;  ///< of the points with a normal
  double rms = 0;           ///< of the inliers' residuals, metres
  int iterations = 0;
  [[nodiscard]] bool usable() const { return status == AlignStatus::aligned || status == AlignStatus::degenerate; }
};

[[nodiscard]] Alignment align_scan(const Reference& reference, const ScanPoints& scan, const PosePrior& prior,
                                   const AlignOptions& options = {});

/// For when odometry is far off: the best heading of a fan about the prior (half-width and step in radians) by the
/// share of points that find a surface, then align_scan from the best few; the best result.
struct FanOptions {
  double half_width = 0.35;
  double step = 0.035;
  int starts = 3;
};
[[nodiscard]] Alignment align_scan_in_fan(const Reference& reference, const ScanPoints& scan, const PosePrior& prior,
                                          const AlignOptions& options = {}, const FanOptions& fan = {});

}  // namespace helicoid
