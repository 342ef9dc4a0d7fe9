#include "helicoid/mapping/point_alignment.hpp"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "helicoid/fit/pair_form.hpp"

namespace helicoid {

namespace {

/// Takes both points of b near those of a: the direction between them is right, and their middle.
Pose2 from_two(const PointPair& first, const PointPair& second) {
  const Vector2d along_a = second.p_a - first.p_a;
  const Vector2d along_b = second.p_b - first.p_b;
  const double yaw = wrap_angle(std::atan2(along_a.y(), along_a.x()) - std::atan2(along_b.y(), along_b.x()));
  const Vector2d middle_b = 0.5 * (first.p_b + second.p_b);
  const Vector2d offset = 0.5 * (first.p_a + second.p_a) - Pose2{0, 0, yaw} * middle_b;
  return {offset.x(), offset.y(), yaw};
}

std::vector<PointPair> agreeing(std::span<const PointPair> pairs, const Pose2& T_a_b, double tolerance) {
  std::vector<PointPair> found;
  for (const PointPair& p : pairs) {
    if ((T_a_b * p.p_b - p.p_a).squaredNorm() < tolerance * tolerance) found.push_back(p);
  }
  return found;
}

/// The largest standard deviation of a's points along any direction.
double spread_of(std::span<const PointPair> pairs) {
  Vector2d mean = Vector2d::Zero();
  for (const PointPair& p : pairs) mean += p.p_a / static_cast<double>(pairs.size());
  Matrix2d moment = Matrix2d::Zero();
  for (const PointPair& p : pairs) {
    moment += (p.p_a - mean) * (p.p_a - mean).transpose() / static_cast<double>(pairs.size());
  }
  const double half_trace = 0.5 * moment.trace();
  return std::sqrt(half_trace + std::sqrt(std::max(0.0, half_trace * half_trace - moment.determinant())));
}

Pose2 least_squares(std::span<const PointPair> pairs, const Pose2& start) {
  PairForm form;
  for (const PointPair& p : pairs) {
    for (const Vector5d& g : point_point_rows(p.p_b, p.p_a)) form.add(g, 1);
  }
  return minimise(form, start).T_a_b;
}

}  // namespace

PointAlignment align_pairs(std::span<const PointPair> pairs, const PointAlignmentOptions& options) {
  PointAlignment best;
  const std::size_t step = 1 + pairs.size() / options.most_tested;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    for (std::size_t j = i + step; j < pairs.size(); j += step) {
      const double apart_a = (pairs[j].p_a - pairs[i].p_a).norm();
      const double apart_b = (pairs[j].p_b - pairs[i].p_b).norm();
      if (apart_a < options.spread || std::abs(apart_a - apart_b) > options.tolerance) continue;
      const Pose2 T_a_b = from_two(pairs[i], pairs[j]);
      const std::size_t count = agreeing(pairs, T_a_b, options.tolerance).size();
      if (count > best.agreeing) best = {false, T_a_b, count};
    }
  }
  if (best.agreeing == 0) return best;
  const std::vector<PointPair> kept = agreeing(pairs, best.T_a_b, options.tolerance);
  best.T_a_b = least_squares(kept, best.T_a_b);
  best.determined = kept.size() >= options.least_pairs && spread_of(kept) >= options.spread &&
                    static_cast<double>(kept.size()) >= options.least_share * static_cast<double>(pairs.size());
  return best;
}

}  // namespace helicoid
