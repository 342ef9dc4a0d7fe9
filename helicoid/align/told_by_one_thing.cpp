#include "helicoid/align/told_by_one_thing.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// Which points of a scan that stands so lie on a surface of the reference.
std::vector<bool> on_surfaces(const Reference& reference, const ScanPoints& scan, const Pose2& T,
                              const AlignOptions& options) {
  const Eigen::Matrix2f R = T.rotation().cast<float>();
  const Eigen::Vector2f t = T.translation().cast<float>();
  std::vector<bool> on(scan.size(), false);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.weight[i] <= 0) continue;
    const Eigen::Vector2f p = R * Eigen::Vector2f(scan.x[i], scan.y[i]) + t;
    const Eigen::Vector2f n = R * Eigen::Vector2f(scan.nx[i], scan.ny[i]);
    const int found = reference.nearest({p.x(), p.y(), n.x(), n.y()}, static_cast<float>(options.last_gate));
    if (found < 0) continue;
    const SurfaceElement e = reference.element(static_cast<std::size_t>(found));
    on[i] = std::abs(e.nx * (p.x() - e.x) + e.ny * (p.y() - e.y)) < static_cast<float>(options.robust_scale);
  }
  return on;
}

}  // namespace

bool is_told_by_one_thing(const Reference& reference, const ScanPoints& scan, const Pose2& T_expected,
                          const Pose2& T_told, double extent, const AlignOptions& options) {
  const std::vector<bool> expected = on_surfaces(reference, scan, T_expected, options);
  const std::vector<bool> told = on_surfaces(reference, scan, T_told, options);
  // A point tells only if its surface lies elsewhere in the one case than in the other: walls tell nothing along them.
  const Matrix2d turned = T_told.rotation() - T_expected.rotation();
  const Vector2d moved = T_told.translation() - T_expected.translation();
  const auto tells = [&](std::size_t i) {
    const Vector2d normal = T_told.rotation() * Vector2d(scan.nx[i], scan.ny[i]);
    return told[i] && !expected[i] &&
           std::abs(normal.dot(turned * Vector2d(scan.x[i], scan.y[i]) + moved)) > options.robust_scale;
  };
  Eigen::Vector2f low(HUGE_VALF, HUGE_VALF);
  Eigen::Vector2f high = -low;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (!tells(i)) continue;
    low = low.cwiseMin(Eigen::Vector2f(scan.x[i], scan.y[i]));
    high = high.cwiseMax(Eigen::Vector2f(scan.x[i], scan.y[i]));
  }
  return low.x() > high.x() || static_cast<double>((high - low).norm()) <= extent;
}

}  // namespace helicoid
