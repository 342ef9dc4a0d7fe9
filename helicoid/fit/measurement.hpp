// What may be known about one node relative to another (III-B): each kind of relation as a cost of the relative pose
// T_a_b, with its first derivatives and its expected information (eq. 7-9).
#pragma once

#include <variant>

#include "helicoid/fit/pair_form.hpp"

namespace helicoid {

/// T_a_b with a cosine and a sine that are at hand anyway.
struct RelativePose {
  double x = 0;
  double y = 0;
  double yaw = 0;  ///< in [-2 pi, 2 pi]
  double cosine = 1;
  double sine = 0;

  [[nodiscard]] static RelativePose of(const Pose2& T_a_b);
};

/// A relative pose was measured: residual (measured^-1 T_a_b) as (x, y, wrapped yaw), as g2o's EDGE_SE2 has it.
struct PosePose {
  Pose2 T_a_b;
  Matrix3d information = Matrix3d::Identity();  ///< of that residual: 1/m^2, 1/(m rad), 1/rad^2; positive semi-definite
};

/// Any number of points on points, points on lines and lines on lines: 1/2 v^T M v * scale. Lines of b: swap a and b.
struct Correspondences {
  const PairForm* form = nullptr;  ///< outlives the fit
  double scale = 1;                ///< 1 / kappa for matched beams
  double least_cost = 0;           ///< c_min / 2 of the form, unscaled: robust losses act on the excess over it
};

/// The distance between a point of a and a point of b was measured. Of two points that coincide the direction is
/// open: they tell nothing then.
struct RelativeRange {
  Vector2d p_a = Vector2d::Zero();  ///< metres
  Vector2d p_b = Vector2d::Zero();
  double range = 0;  ///< metres
  double sigma = 1;  ///< metres
};

/// The direction from a's point to b's point was measured, anticlockwise from a's x axis; residual wrapped.
struct RelativeBearing {
  Vector2d p_a = Vector2d::Zero();  ///< metres
  Vector2d p_b = Vector2d::Zero();
  double bearing = 0;  ///< radians
  double sigma = 1;    ///< radians
};

/// The place of b (a landmark, or a robot of unknown heading) was measured in a's frame; g2o's EDGE_SE2_XY.
struct PointPosition {
  Vector2d p_a = Vector2d::Zero();              ///< metres
  Matrix2d information = Matrix2d::Identity();  ///< 1/m^2, in a's frame
};

using Measurement = std::variant<PosePose, Correspondences, RelativeRange, RelativeBearing, PointPosition>;

/// Cost (chi^2 / 2), gradient and expected information by (t_x, t_y, phi) of T_a_b.
[[nodiscard]] PairExpansion expand(const Measurement& measurement, const RelativePose& T_a_b);
[[nodiscard]] double cost(const Measurement& measurement, const RelativePose& T_a_b);

/// An angle of less than three turns, wrapped to [-pi, pi].
[[nodiscard]] double wrap_small(double angle);

}  // namespace helicoid
