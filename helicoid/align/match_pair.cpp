#include "helicoid/align/match_pair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "helicoid/align/nearest_on_side.hpp"
#include "helicoid/align/open_direction.hpp"
#include "helicoid/base/wide_lanes.hpp"
#include "helicoid/sensor/beam_finder.hpp"

namespace helicoid {

namespace {

/// Which of a's points to read for a place in a's laser frame: the beams that look within `gate` of it.
class BeamWindow {
 public:
  BeamWindow(const LaserModel& laser, const ScanPoints& points, double gate)
      : beam_(laser),
        per_step_(static_cast<float>(1 / laser.bearing_step)),
        gate_(static_cast<float>(gate)),
        beams_(laser.beams) {
    // first_[k]: the first point whose beam is k or later.
    first_.assign(static_cast<std::size_t>(beams_) + 1, static_cast<std::uint16_t>(points.size()));
    for (std::size_t i = points.size(); i-- > 0;) first_[points.beam[i]] = static_cast<std::uint16_t>(i);
    for (auto k = static_cast<std::size_t>(beams_); k-- > 0;) first_[k] = std::min(first_[k], first_[k + 1]);
  }

  struct Range {
    int first = 0;
    int last = 0;  ///< one past
  };
  [[nodiscard]] Range at(float x, float y) const {
    const float range = std::sqrt(x * x + y * y);
    if (range <= 2 * gate_) return {first_.front(), first_.back()};
    const float beam = beam_.at(x, y);
    const float window = gate_ / range * per_step_ + 1.5F;
    const int low = std::max(0, static_cast<int>(beam - window));
    const int high = std::min(beams_, static_cast<int>(beam + window) + 1);
    if (low >= high) return {};
    return {first_[low], first_[high]};
  }

 private:
  BeamFinder beam_;
  float per_step_, gate_;
  int beams_;
  std::vector<std::uint16_t> first_;
};

/// A rotation and translation in floats, for many points.
struct PointTransform {
  explicit PointTransform(const Pose2& T)
      : c(static_cast<float>(std::cos(T.yaw))),
        s(static_cast<float>(std::sin(T.yaw))),
        x(static_cast<float>(T.x)),
        y(static_cast<float>(T.y)) {}
  [[nodiscard]] Eigen::Vector2f operator()(const Eigen::Vector2f& p) const {
    return {x + c * p.x() - s * p.y(), y + s * p.x() + c * p.y()};
  }
  float c, s, x, y;
};

/// A point of b, the line of a that it was found on, and what that is worth.
struct Correspondence {
  Eigen::Vector2f p_b, q_a, normal;
  double facing;  ///< b's cosine of incidence less a's
  double weight;  ///< without the residual's
};

/// What is bright or dark is measured long or short, beam after beam: across a wall by the cosine of incidence of that.
/// A wall seen ahead and then abreast so seems to have moved or turned. Walls that look one way, within a sixteenth of
/// a circle, share one such unknown.
class SurfaceBiases {
 public:
  void add(const Vector5d& row, const Vector2d& normal, double facing, double weight) {
    by_sector_[sector(normal)].add(row, facing, weight);
  }
  void marginalise(PairForm& form, double sigma) const {
    for (const SharedUnknown& shared : by_sector_) {
      if (shared.square > 0) form.marginalise(shared, sigma);
    }
  }

 private:
  static std::size_t sector(const Vector2d& n) {
    constexpr double kHalfOctant = 0.41421356;  // tan 22.5 degrees
    const double x = std::abs(n.x());
    const double y = std::abs(n.y());
    return (n.x() < 0 ? 1U : 0U) + (n.y() < 0 ? 2U : 0U) + (y > x ? 4U : 0U) +
           (std::min(x, y) > kHalfOctant * std::max(x, y) ? 8U : 0U);
  }
  std::array<SharedUnknown, 16> by_sector_;
};

struct Correspondences {
  std::vector<Correspondence> all;
  NormalScatter scatter;
  int candidates = 0;  ///< points of b with a normal that look at a place within a's view
};

HELICOID_WIDE_LANES
Correspondences find_correspondences(const PairReference& a, const ScanPoints& b, const Pose2& T_a_b,
                                     const MatchPairOptions& options) {
  Correspondences found;
  found.all.reserve(b.size());
  const ScanPoints& lines = *a.points;
  const OrientedPoints oriented{lines.x.data(), lines.y.data(), lines.nx.data(), lines.ny.data(),
                                static_cast<int>(lines.size())};
  const BeamWindow window(*a.laser, lines, options.gate);
  const PointTransform to_a(T_a_b);
  const PointTransform to_laser(a.T_patch_laser.inverse() * T_a_b);
  const auto gate = static_cast<float>(options.gate);
  const double bias_share = options.incidence_bias / options.range_sigma;
  for (std::size_t i = 0; i < b.size(); ++i) {
    if (b.weight[i] <= 0) continue;
    const Eigen::Vector2f p_b(b.x[i], b.y[i]);
    const Eigen::Vector2f p_laser = to_laser(p_b);
    const auto range = window.at(p_laser.x(), p_laser.y());
    if (range.first == range.last) continue;
    ++found.candidates;
    const Eigen::Vector2f p_a = to_a(p_b);
    const float nx = to_a.c * b.nx[i] - to_a.s * b.ny[i];
    const float ny = to_a.s * b.nx[i] + to_a.c * b.ny[i];
    // A scan is ordered by bearing, so only beams that look within the gate of the place need be read.
    NearestOnSide nearest({p_a.x(), p_a.y(), nx, ny}, gate);
    nearest.look(oriented, range.first, range.last);
    const int j = nearest.found();
    if (j < 0) continue;
    const double facing = static_cast<double>(b.facing[i] - lines.facing[j]);
    const double bias = bias_share * facing;
    const double weight = static_cast<double>(b.weight[i]) * lines.weight[j] / (1 + bias * bias);
    found.all.push_back({p_b, {lines.x[j], lines.y[j]}, {lines.nx[j], lines.ny[j]}, facing, weight});
    found.scatter.add(lines.nx[j], lines.ny[j], weight);
  }
  return found;
}

}  // namespace

HELICOID_WIDE_LANES
PairMatch match_pair(const PairReference& a, const ScanPoints& b, const Pose2& T_a_b, const MatchPairOptions& options) {
  const Correspondences found = find_correspondences(a, b, T_a_b, options);
  const std::optional<Eigen::Vector2f> open = found.scatter.open_direction();
  const PointTransform to_a(T_a_b);
  const double information = 1 / (options.range_sigma * options.range_sigma);
  const double per_square_scale = 1 / (options.robust_scale * options.robust_scale);
  SurfaceBiases biases;
  PairMatch match;
  match.candidates = found.candidates;
  for (const Correspondence& c : found.all) {
    const Vector2d normal = (open ? squared_to(*open, c.normal) : c.normal).cast<double>();
    const double residual = normal.dot((to_a(c.p_b) - c.q_a).cast<double>());
    const double robust = 1 / (1 + residual * residual * per_square_scale);
    const double weight = c.weight * robust * robust;
    const Vector5d row = point_line_row(c.p_b.cast<double>(), c.q_a.cast<double>(), normal);
    match.form.add(row, weight * information);
    biases.add(row, normal, c.facing, weight * information);
    match.squares += weight * residual * residual;
    if (robust > 0.2) ++match.correspondences;
  }
  biases.marginalise(match.form, options.surface_bias);
  return match;
}

}  // namespace helicoid
