#include "helicoid/manifold/seen_free.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

SeenFree::SeenFree(const Patch& patch) : ranges_(patch.free_ranges), measured_(patch.scan.ranges), beams_(patch.laser) {
  const Pose2 T_laser_patch = patch.scan.T_robot_laser.inverse();
  R_laser_patch_ = T_laser_patch.rotation().cast<float>();
  t_laser_patch_ = T_laser_patch.translation().cast<float>();
}

std::ptrdiff_t SeenFree::beam_at(const Eigen::Vector2f& p_laser) const {
  const auto beam = static_cast<std::ptrdiff_t>(std::floor(beams_.at(p_laser.x(), p_laser.y()) + 0.5F));
  return beam < 1 || beam + 1 >= std::ssize(ranges_) ? -1 : beam;
}

bool SeenFree::is_deep(const Eigen::Vector2f& p_patch, float depth) const {
  const Eigen::Vector2f p_laser = R_laser_patch_ * p_patch + t_laser_patch_;
  const std::ptrdiff_t beam = beam_at(p_laser);
  if (beam < 0) return false;
  const float needed = p_laser.norm() + depth;
  const float* at = ranges_.data() + beam;
  return at[-1] >= needed && at[0] >= needed && at[1] >= needed;
}

bool SeenFree::ends_at(const Eigen::Vector2f& p_patch, float within) const {
  const Eigen::Vector2f p_laser = R_laser_patch_ * p_patch + t_laser_patch_;
  const std::ptrdiff_t beam = beam_at(p_laser);
  if (beam < 0) return false;
  const float expected = p_laser.norm();
  const float* at = measured_.data() + beam;
  return std::abs(at[-1] - expected) <= within || std::abs(at[0] - expected) <= within ||
         std::abs(at[1] - expected) <= within;
}

int count_contradictions(const Patch& patch, const ScanPoints& points, const Pose2& T_patch_points, double depth) {
  const SeenFreeFrom free(patch, T_patch_points);
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.weight[i] <= 0) continue;
    count += free.is_deep({points.x[i], points.y[i]}, static_cast<float>(depth)) ? 1 : 0;
  }
  return count;
}

int count_contradictions(const Patch& a, const Patch& b, const Pose2& T_a_b, double depth) {
  return count_contradictions(a, b.points, T_a_b, depth) + count_contradictions(b, a.points, T_a_b.inverse(), depth);
}

namespace {

int count_across(const Patch& patch, const ScanPoints& points, const Pose2& T_patch_points, double depth) {
  constexpr float kGrazing = 0.05F;  // cosine; nearer to the wall's own direction a beam tells nothing of its depth
  const SeenFreeFrom free(patch, T_patch_points);
  const Eigen::Vector2f laser = (T_patch_points.inverse() * patch.scan.T_robot_laser).translation().cast<float>();
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.weight[i] <= 0) continue;
    const Eigen::Vector2f p(points.x[i], points.y[i]);
    const float across = std::abs((p - laser).normalized().dot(Eigen::Vector2f(points.nx[i], points.ny[i])));
    count += free.is_deep(p, static_cast<float>(depth) / std::max(across, kGrazing)) ? 1 : 0;
  }
  return count;
}

}  // namespace

int count_contradictions_across(const Patch& a, const Patch& b, const Pose2& T_a_b, double depth) {
  return count_across(a, b.points, T_a_b, depth) + count_across(b, a.points, T_a_b.inverse(), depth);
}

}  // namespace helicoid
