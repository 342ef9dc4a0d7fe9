// Losses that let wrong relations go (Huber 1964; truncated least squares with graduated non-convexity: Yang et al.
// 2020). They act on chi^2, the excess over what a relation costs at its own best.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace helicoid {

enum class LossKind : std::uint8_t { quadratic, huber, cauchy, truncated };

struct RobustLoss {
  LossKind kind = LossKind::quadratic;
  double width = 3.37;  ///< where it bends, as a root of chi^2; 3.37^2 is the 99 % quantile of 3 degrees of freedom
  /// Graduated non-convexity: 0 is the truncated loss itself; larger is softer, up to convex.
  double softness = 0;
};

/// The loss and its derivative by chi^2 (the weight); quadratic: {chi2, 1}.
struct Loss {
  double value = 0;
  double weight = 1;
};

[[nodiscard]] inline Loss evaluate(const RobustLoss& loss, double chi2) {
  const double square = loss.width * loss.width;
  switch (loss.kind) {
    case LossKind::huber:
      if (chi2 <= square) return {chi2, 1};
      return {2 * loss.width * std::sqrt(chi2) - square, loss.width / std::sqrt(chi2)};
    case LossKind::cauchy: return {square * std::log1p(chi2 / square), 1 / (1 + chi2 / square)};
    case LossKind::truncated: {
      // With mu = 1 / softness: quadratic up to mu/(mu+1) w^2, constant from (mu+1)/mu w^2 on (their eq. 12-14).
      if (loss.softness <= 0) return chi2 <= square ? Loss{chi2, 1} : Loss{square, 0};
      const double mu = 1 / loss.softness;
      if (chi2 <= mu / (mu + 1) * square) return {chi2, 1};
      if (chi2 >= (mu + 1) / mu * square) return {square, 0};
      const double root = std::sqrt(chi2);
      const double factor = std::sqrt(mu * (mu + 1));
      return {2 * loss.width * root * factor - mu * (square + chi2), std::max(0.0, loss.width / root * factor - mu)};
    }
    default: return {chi2, 1};
  }
}

}  // namespace helicoid
