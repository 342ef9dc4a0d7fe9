// The direction of a vector, fast: for choosing which beam looks at a point, not for fitting.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace helicoid {

/// atan2(y, x) to 2e-5 rad by a polynomial of the ninth degree (Abramowitz and Stegun 1964, 4.4.49); 0 at the origin.
[[nodiscard]] inline float approximate_atan2(float y, float x) {
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float t = std::min(ax, ay) / std::max(std::max(ax, ay), 1e-30F);
  const float u = t * t;
  float angle = t * (0.9998660F + u * (-0.3302995F + u * (0.1801410F + u * (-0.0851330F + u * 0.0208351F))));
  // Chosen, not branched to: so that a loop over many is one of vectors.
  angle = ay > ax ? 0.5F * std::numbers::pi_v<float> - angle : angle;
  angle = x < 0 ? std::numbers::pi_v<float> - angle : angle;
  return y < 0 ? -angle : angle;
}

/// The equal angle in [-pi, pi), in floats.
[[nodiscard]] inline float approximate_wrap(float angle) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  return angle - kTurn * std::floor(angle / kTurn + 0.5F);
}

}  // namespace helicoid
