#include "helicoid/align/match_pair.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr float kSameSide = 0.7F;

/// The point of `a` nearest to (x, y) with an agreeing normal: a scan is ordered by bearing, so only beams that look
/// within the gate of the place need be read. -1 if there is none.
int nearest_by_bearing(const ScanPoints& a, float x, float y, float nx, float ny, int first, int last, float gate) {
  float best = gate * gate;
  int found = -1;
  for (int j = first; j < last; ++j) {
    if (a.weight[j] <= 0 || a.nx[j] * nx + a.ny[j] * ny < kSameSide) continue;
    const float dx = a.x[j] - x;
    const float dy = a.y[j] - y;
    const float square = dx * dx + dy * dy;
    if (square < best) {
      best = square;
      found = j;
    }
  }
  return found;
}

}  // namespace

PairMatch match_pair(const PairReference& a, const ScanPoints& b, const Pose2& T_a_b, const MatchPairOptions& options) {
  PairMatch match;
  const Pose2 T_laser_b = a.T_patch_laser.inverse() * T_a_b;
  const Matrix2d R = T_a_b.rotation();
  const Vector2d t = T_a_b.translation();
  const ScanPoints& lines = *a.points;
  for (std::size_t i = 0; i < b.size(); ++i) {
    if (b.weight[i] <= 0) continue;
    const Vector2d p_b(b.x[i], b.y[i]);
    const Vector2d p_laser = T_laser_b * p_b;
    const double range = p_laser.norm();
    const double bearing = std::atan2(p_laser.y(), p_laser.x());
    const double half_view = 0.5 * a.laser->field_of_view();
    const double beam = (wrap_angle(bearing - a.laser->first_bearing - half_view) + half_view) / a.laser->bearing_step;
    const double window = range > options.gate ? options.gate / (range * a.laser->bearing_step) + 1 : a.laser->beams;
    if (beam + window < 0 || beam - window > a.laser->beams) continue;
    ++match.candidates;
    const auto low = static_cast<std::uint16_t>(std::max(0.0, beam - window));
    const auto high = static_cast<std::uint16_t>(std::clamp(beam + window + 1, 0.0, 65535.0));
    const auto first = std::lower_bound(lines.beam.begin(), lines.beam.end(), low) - lines.beam.begin();
    const auto last = std::lower_bound(lines.beam.begin() + first, lines.beam.end(), high) - lines.beam.begin();
    const Vector2d p_a = R * p_b + t;
    const Vector2d n_a = R * Vector2d(b.nx[i], b.ny[i]);
    const int j = nearest_by_bearing(lines, static_cast<float>(p_a.x()), static_cast<float>(p_a.y()),
                                     static_cast<float>(n_a.x()), static_cast<float>(n_a.y()),
                                     static_cast<int>(first), static_cast<int>(last), static_cast<float>(options.gate));
    if (j < 0) continue;
    const Vector2d q_a(lines.x[j], lines.y[j]);
    const Vector2d normal(lines.nx[j], lines.ny[j]);
    const double residual = normal.dot(p_a - q_a);
    const double robust = 1 / (1 + residual * residual / (options.robust_scale * options.robust_scale));
    const double weight = static_cast<double>(b.weight[i]) * lines.weight[j] * robust * robust;
    match.form.add(point_line_row(p_b, q_a, normal), weight / (options.range_sigma * options.range_sigma));
    match.squares += weight * residual * residual;
    if (robust > 0.2) ++match.correspondences;
  }
  return match;
}

}  // namespace helicoid
