#include "helicoid/mapping/island_join.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "helicoid/geometry/covariance.hpp"
#include "helicoid/mapping/sighting_fit.hpp"

namespace helicoid {

namespace {

constexpr int kStarts = 24;
constexpr int kIterations = 25;

/// What is minimised: chi^2 with its gradient and Gauss-Newton information by (x, y, yaw) of T_a_b.
struct Normal {
  double chi2 = 0;
  int measurements = 0;
  Vector3d gradient = Vector3d::Zero();
  Matrix3d information = Matrix3d::Zero();
  void add(double residual, double sigma, const Eigen::RowVector3d& J) {
    const double weight = 1 / (sigma * sigma);
    chi2 += weight * residual * residual;
    gradient += weight * residual * J.transpose();
    information += weight * J.transpose() * J;
    ++measurements;
  }
};

/// One sighting with all that stays fixed multiplied out: T_observer_observed = T_left * X * T_right, where X is T_a_b
/// or its inverse.
struct Ray {
  Pose2 T_left, T_right;
  bool forward = true;
  const Sighting* sighting = nullptr;
};

void add(Normal& normal, const Ray& ray, const Pose2& T_a_b) {
  Matrix3d by_X = Matrix3d::Identity();
  Pose2 X = T_a_b;
  if (!ray.forward) {
    const Inversion inverse = invert_with_jacobian(T_a_b);
    X = inverse.T_b_a;
    by_X = inverse.by_pose;
  }
  const Composition left = compose_with_jacobians(ray.T_left, X);
  const Composition all = compose_with_jacobians(left.T_a_c, ray.T_right);
  const Matrix3d J = all.by_first * left.by_second * by_X;
  const Pose2& T = all.T_a_c;
  const Sighting& s = *ray.sighting;
  const double range = std::max(T.distance(), 1e-6);
  if (s.range) normal.add(range - *s.range, s.sigma_range, (T.x * J.row(0) + T.y * J.row(1)) / range);
  if (s.bearing) {
    normal.add(wrap_angle(std::atan2(T.y, T.x) - *s.bearing), s.sigma_bearing,
               (T.x * J.row(1) - T.y * J.row(0)) / (range * range));
  }
  if (s.orientation) normal.add(wrap_angle(T.yaw - *s.orientation), s.sigma_orientation, J.row(2));
}

Normal linearise(std::span<const Ray> rays, const Pose2& T_a_b) {
  Normal normal;
  for (const Ray& ray : rays) add(normal, ray, T_a_b);
  return normal;
}

/// Levenberg-Marquardt: ranges curve strongly.
struct Minimum {
  Pose2 T_a_b;
  Normal normal;
};
Minimum minimise_from(std::span<const Ray> rays, const Pose2& start) {
  Minimum at{start, linearise(rays, start)};
  double damping = 1e-3;
  for (int i = 0; i < kIterations; ++i) {
    Matrix3d H = at.normal.information;
    H.diagonal() *= 1 + damping;
    H.diagonal().array() += 1e-9;
    const Vector3d step = -H.ldlt().solve(at.normal.gradient);
    const Pose2 next = Pose2::from_vector(at.T_a_b.vector() + step);
    const Normal there = linearise(rays, next);
    if (there.chi2 < at.normal.chi2) {
      at = {next, there};
      damping *= 0.2;
      if (step.norm() < 1e-7) break;
    } else {
      damping *= 8;
      if (damping > 1e8) break;
    }
  }
  return at;
}

/// Poses from which the optimum may be reached: the observed robot where the sighting says, unknown angles all round.
std::vector<Pose2> starts_of(const Ray& ray) {
  const Sighting& s = *ray.sighting;
  const int bearings = s.bearing ? 1 : kStarts;
  const int orientations = s.orientation ? 1 : kStarts;
  std::vector<Pose2> starts;
  const double range = s.range.value_or(2);
  for (int i = 0; i < bearings; ++i) {
    const double bearing = s.bearing.value_or(2 * std::numbers::pi * i / kStarts);
    for (int j = 0; j < orientations; ++j) {
      const double yaw = wrap_angle(s.orientation.value_or(2 * std::numbers::pi * j / kStarts));
      const Pose2 T_observer_observed{range * std::cos(bearing), range * std::sin(bearing), yaw};
      const Pose2 X = ray.T_left.inverse() * T_observer_observed * ray.T_right.inverse();
      starts.push_back(ray.forward ? X : X.inverse());
    }
  }
  return starts;
}

/// The sightings in terms of two patches of the two islands.
std::vector<Ray> rays_between(const Map& map, std::span<const PlacedSighting> sightings, PatchId a, PatchId b) {
  std::vector<Ray> rays;
  for (const PlacedSighting& placed : sightings) {
    if (!is_usable(placed.sighting)) continue;
    const bool forward = map.island_of(placed.observer.patch) == map.island_of(a);
    const Pose2& T_plane_near = map.T_plane_patch(forward ? a : b);
    const Pose2& T_plane_far = map.T_plane_patch(forward ? b : a);
    rays.push_back({map.project(placed.observer).inverse() * T_plane_near,
                    T_plane_far.inverse() * map.project(placed.observed), forward, &placed.sighting});
  }
  return rays;
}

bool is_determined(const Normal& normal, const IslandJoinOptions& options) {
  const Eigen::LLT<Matrix3d> factor(normal.information);
  if (normal.measurements < 3 || factor.info() != Eigen::Success) return false;
  const ConfidenceInterval interval = confidence_interval(factor.solve(Matrix3d::Identity()));
  return interval.position < options.position && interval.heading < options.heading;
}

}  // namespace

IslandJoin estimate_join(const Map& map, std::span<const PlacedSighting> sightings, const IslandJoinOptions& options) {
  IslandJoin join;
  if (sightings.empty()) return join;
  join.a = std::min(sightings.back().observer.patch, sightings.back().observed.patch);
  join.b = std::max(sightings.back().observer.patch, sightings.back().observed.patch);
  const std::vector<Ray> rays = rays_between(map, sightings, join.a, join.b);
  if (rays.empty()) return join;
  std::vector<Minimum> minima;
  for (const Pose2& start : starts_of(rays.back())) minima.push_back(minimise_from(rays, start));
  const auto best = std::min_element(minima.begin(), minima.end(),
                                     [](const Minimum& x, const Minimum& y) { return x.normal.chi2 < y.normal.chi2; });
  const bool rivalled = std::any_of(minima.begin(), minima.end(), [&](const Minimum& m) {
    const Pose2 off = best->T_a_b.inverse() * m.T_a_b;
    return m.normal.chi2 < best->normal.chi2 + options.rival &&
           (off.distance() > options.position || std::abs(off.yaw) > options.heading);
  });
  join.T_a_b = best->T_a_b;
  join.information = best->normal.information;
  join.chi2 = best->normal.chi2;
  join.measurements = best->normal.measurements;
  join.determined = !rivalled && is_determined(best->normal, options);
  return join;
}

}  // namespace helicoid
