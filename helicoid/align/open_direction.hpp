// The direction that a match leaves open. Lasers measure long by a centimetre or two on some surfaces, so that a
// straight wall looks bent about the place abreast of the robot, and that bend travels with the robot. Along a corridor
// it is all that there is to see, and it says that the robot stands still. Normals are known to a few degrees: what
// they say of that direction within these is not evidence.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <optional>

namespace helicoid {

/// Weighted normals of the surfaces that were matched, summed: sum of w n n^T.
struct NormalScatter {
  double xx = 0, xy = 0, yy = 0;

  void add(double nx, double ny, double weight) {
    xx += weight * nx * nx;
    xy += weight * nx * ny;
    yy += weight * ny * ny;
  }

  /// The unit vector along which next to no normal points, in their frame; none if all directions are told.
  [[nodiscard]] std::optional<Eigen::Vector2f> open_direction() const {
    constexpr double kNextToNone = 0.05;  // of all weight
    const double trace = xx + yy;
    const double spread = std::hypot(xx - yy, 2 * xy);
    if (!(0.5 * (trace - spread) < kNextToNone * trace)) return std::nullopt;
    const double along = 0.5 * std::atan2(2 * xy, xx - yy) + 0.5 * std::numbers::pi;
    return Eigen::Vector2f(static_cast<float>(std::cos(along)), static_cast<float>(std::sin(along)));
  }
};

/// The normal made square to the open direction, if it is so to within its error; what points along it is evidence.
[[nodiscard]] inline Eigen::Vector2f squared_to(const Eigen::Vector2f& open, const Eigen::Vector2f& normal) {
  constexpr float kError = 0.12F;  // sine: 7 degrees
  const float along = open.dot(normal);
  if (std::abs(along) > kError) return normal;
  return (normal - along * open).normalized();
}

}  // namespace helicoid
