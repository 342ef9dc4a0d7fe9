#include "helicoid/eval/coverage.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kChiSquare95 = 7.815;  // three degrees of freedom
constexpr double kTwoSided95 = 1.96;

double percent(std::size_t part, std::size_t whole) {
  return whole > 0 ? 100 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

void Coverage::add(const UncertainPose2& stated, const Pose2& T_a_b_true) {
  const Vector3d error(T_a_b_true.x - stated.T_a_b.x, T_a_b_true.y - stated.T_a_b.y,
                       wrap_angle(T_a_b_true.yaw - stated.T_a_b.yaw));
  const double square = error.dot(stated.covariance.ldlt().solve(error));
  ++count_;
  nees_ += square;
  inside_region_ += square < kChiSquare95 ? 1 : 0;
  for (int k = 0; k < 3; ++k) {
    inside_[k] += std::abs(error[k]) < kTwoSided95 * std::sqrt(stated.covariance(k, k)) ? 1 : 0;
  }
}

double Coverage::nees_per_freedom() const {
  return count_ > 0 ? nees_ / (3 * static_cast<double>(count_)) : 0;
}

double Coverage::inside_percent(int component) const {
  return percent(inside_[component], count_);
}

double Coverage::region_percent() const {
  return percent(inside_region_, count_);
}

}  // namespace helicoid
