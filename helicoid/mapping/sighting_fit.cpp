#include "helicoid/mapping/sighting_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kNearest = 0.05;  ///< no two robots are nearer, metres

}  // namespace

bool SightingFit::agrees() const {
  // The 99.9 % quantiles of chi^2.
  constexpr double kQuantiles[] = {0, 10.828, 13.816, 16.266};
  return chi2 <= kQuantiles[std::clamp(measurements, 0, 3)];
}

bool is_usable(const Sighting& s) {
  const auto bad = [](const std::optional<double>& value, double sigma) {
    return value && (!std::isfinite(*value) || !(sigma > 0) || !std::isfinite(sigma));
  };
  return !bad(s.range, s.sigma_range) && !bad(s.bearing, s.sigma_bearing) && !bad(s.orientation, s.sigma_orientation);
}

SightingFit fit_of(const Sighting& s, const UncertainPose2& T_observer_observed) {
  const Pose2& T = T_observer_observed.T_a_b;
  const double range = std::max(T.distance(), kNearest);
  Matrix3d J = Matrix3d::Zero();
  Vector3d residual = Vector3d::Zero();
  Vector3d variance = Vector3d::Zero();
  int count = 0;
  const auto add = [&](const std::optional<double>& measured, double off, double sigma, const Eigen::RowVector3d& row) {
    if (!measured) return;
    J.row(count) = row;
    residual[count] = off;
    variance[count++] = sigma * sigma;
  };
  add(s.range, T.distance() - s.range.value_or(0), s.sigma_range, {T.x / range, T.y / range, 0});
  add(s.bearing, wrap_angle(std::atan2(T.y, T.x) - s.bearing.value_or(0)), s.sigma_bearing,
      {-T.y / (range * range), T.x / (range * range), 0});
  add(s.orientation, wrap_angle(T.yaw - s.orientation.value_or(0)), s.sigma_orientation, {0, 0, 1});
  if (count == 0) return {};
  const Eigen::MatrixXd C = (J * T_observer_observed.covariance * J.transpose()).topLeftCorner(count, count) +
                            Eigen::MatrixXd(variance.head(count).asDiagonal());
  return {residual.head(count).dot(C.ldlt().solve(residual.head(count))), count};
}

std::optional<UncertainPose2> whole_pose(const Sighting& s) {
  if (!s.range || !s.bearing || !s.orientation) return std::nullopt;
  UncertainPose2 T;
  T.T_a_b = {*s.range * std::cos(*s.bearing), *s.range * std::sin(*s.bearing), wrap_angle(*s.orientation)};
  Matrix3d along = Matrix3d::Zero();
  along.diagonal() << s.sigma_range * s.sigma_range, std::pow(*s.range * s.sigma_bearing, 2),
      s.sigma_orientation * s.sigma_orientation;
  T.covariance = turned(along, *s.bearing);
  return T;
}

}  // namespace helicoid
