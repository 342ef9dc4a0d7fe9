#include "helicoid/align/align_scan.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace helicoid {

namespace {

/// The normal equations of one round.
struct Round {
  Matrix3d information = Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
  double squares = 0;
  double weights = 0;
  int candidates = 0;
  int inliers = 0;
};

/// Pairs every stride-th point with the reference and sums residuals (E step and the linearisation of eq. 13).
Round sum_residuals(const Reference& reference, const ScanPoints& scan, const Pose2& T, float gate, float robust_scale,
                    std::size_t stride) {
  const auto c = static_cast<float>(std::cos(T.yaw));
  const auto s = static_cast<float>(std::sin(T.yaw));
  const auto tx = static_cast<float>(T.x);
  const auto ty = static_cast<float>(T.y);
  const float inverse_square_scale = 1 / (robust_scale * robust_scale);
  float hxx = 0, hxy = 0, hyy = 0, hxt = 0, hyt = 0, htt = 0, gx = 0, gy = 0, gt = 0, squares = 0, weights = 0;
  Round round;
  for (std::size_t i = 0; i < scan.size(); i += stride) {
    if (scan.weight[i] <= 0) continue;
    ++round.candidates;
    const float lx = c * scan.x[i] - s * scan.y[i];
    const float ly = s * scan.x[i] + c * scan.y[i];
    const float nx = c * scan.nx[i] - s * scan.ny[i];
    const float ny = s * scan.nx[i] + c * scan.ny[i];
    const SurfaceElement* e = reference.nearest(lx + tx, ly + ty, nx, ny, gate);
    if (e == nullptr) continue;
    const float r = e->nx * (lx + tx - e->x) + e->ny * (ly + ty - e->y);
    const float square = r * r;
    const float robust = 1 / (1 + square * inverse_square_scale);
    const float w = scan.weight[i] * robust * robust;
    const float jt = e->ny * lx - e->nx * ly;
    hxx += w * e->nx * e->nx;
    hxy += w * e->nx * e->ny;
    hyy += w * e->ny * e->ny;
    hxt += w * e->nx * jt;
    hyt += w * e->ny * jt;
    htt += w * jt * jt;
    gx += w * e->nx * r;
    gy += w * e->ny * r;
    gt += w * jt * r;
    squares += w * square;
    weights += w;
    if (square < 4 * robust_scale * robust_scale) ++round.inliers;
  }
  round.information << hxx, hxy, hxt, hxy, hyy, hyt, hxt, hyt, htt;
  round.gradient << gx, gy, gt;
  round.squares = squares;
  round.weights = weights;
  return round;
}

Vector3d difference(const Pose2& a, const Pose2& b) { return {a.x - b.x, a.y - b.y, wrap_angle(a.yaw - b.yaw)}; }

/// A direction is open when the beams, honestly counted, say less about it than this many metres (or radians per
/// metre of lever) allow.
bool is_degenerate(const Matrix3d& information, double kappa) {
  constexpr double kOpen = 0.05;
  const Matrix2d position = information.topLeftCorner<2, 2>();
  const double trace = position.trace();
  const double spread = std::hypot(position(0, 0) - position(1, 1), 2 * position(0, 1));
  const double smallest = 0.5 * (trace - spread) / kappa;
  return smallest < 1 / (kOpen * kOpen);
}

}  // namespace

const char* name_of(AlignStatus status) {
  switch (status) {
    case AlignStatus::aligned: return "aligned";
    case AlignStatus::too_few_points: return "too few points";
    case AlignStatus::empty_reference: return "empty reference";
    case AlignStatus::too_few_inliers: return "too few inliers";
    case AlignStatus::degenerate: return "degenerate";
    case AlignStatus::diverged: return "diverged";
  }
  return "unknown";
}

Alignment align_scan(const Reference& reference, const ScanPoints& scan, const PosePrior& prior,
                     const AlignOptions& options) {
  Alignment result;
  result.T_reference_scan = prior.T_reference_scan;
  const auto usable = std::count_if(scan.weight.begin(), scan.weight.end(), [](float w) { return w > 0; });
  if (usable < options.min_points) return result;
  result.status = AlignStatus::empty_reference;
  if (reference.empty()) return result;

  const double beam_information = 1 / (options.range_sigma * options.range_sigma);
  const double against_prior = beam_information / options.kappa;
  double gate = options.first_gate;
  std::size_t stride = 2;
  int full_rounds = 0;
  Round round;
  Pose2 T = prior.T_reference_scan;
  while (result.iterations < options.max_iterations) {
    ++result.iterations;
    const double scale = std::max(options.robust_scale, 0.33 * gate);
    round = sum_residuals(reference, scan, T, static_cast<float>(gate), static_cast<float>(scale), stride);
    const Vector3d off = difference(T, prior.T_reference_scan);
    // Odometry has heavy tails: a prior that the beams contradict fades (Student's t).
    const double believed = options.prior_freedom / (options.prior_freedom + off.dot(prior.information * off));
    const Matrix3d H = against_prior * round.information + believed * prior.information;
    const Vector3d g = against_prior * round.gradient + believed * prior.information * off;
    const Vector3d step = -(H + 1e-9 * H.trace() * Matrix3d::Identity()).ldlt().solve(g);
    T = Pose2::from_vector(T.vector() + step);
    const bool small = step.head<2>().norm() < 0.25 * gate && std::abs(step[2]) < 0.05 * gate;
    const bool tiny = step.head<2>().norm() < 1e-3 && std::abs(step[2]) < 3e-4;
    if (stride == 1 && (++full_rounds >= 4 || (full_rounds >= 2 && tiny))) break;
    if (gate > options.last_gate) {
      if (small) gate = std::max(options.last_gate, 0.4 * gate);
    } else if (tiny || result.iterations >= options.max_iterations - 3) {
      stride = 1;
    }
  }
  result.T_reference_scan = T;
  result.information = beam_information * round.information;
  result.inlier_share = round.candidates > 0 ? static_cast<double>(round.inliers) / round.candidates : 0;
  result.rms = round.weights > 0 ? std::sqrt(round.squares / round.weights) : 0;
  if (result.inlier_share < options.min_inlier_share) {
    result.status = AlignStatus::too_few_inliers;
  } else {
    result.status = is_degenerate(result.information, options.kappa) ? AlignStatus::degenerate : AlignStatus::aligned;
  }
  return result;
}

Alignment align_scan_in_fan(const Reference& reference, const ScanPoints& scan, const PosePrior& prior,
                            const AlignOptions& options, const FanOptions& fan) {
  struct Start {
    double score;
    double offset;
  };
  std::vector<Start> starts;
  const int steps = static_cast<int>(std::ceil(fan.half_width / fan.step));
  for (int k = -steps; k <= steps; ++k) {
    Pose2 T = prior.T_reference_scan;
    T.yaw = wrap_angle(T.yaw + k * fan.step);
    const Round round = sum_residuals(reference, scan, T, 0.3F, 0.1F, 3);
    starts.push_back({round.weights, k * fan.step});
  }
  std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.score > b.score; });
  Alignment best;
  best.T_reference_scan = prior.T_reference_scan;
  for (int i = 0; i < std::min(fan.starts, static_cast<int>(starts.size())); ++i) {
    PosePrior moved = prior;
    moved.T_reference_scan.yaw = wrap_angle(moved.T_reference_scan.yaw + starts[i].offset);
    const Alignment a = align_scan(reference, scan, moved, options);
    const int iterations = best.iterations + a.iterations;
    if (i == 0 || a.inlier_share > best.inlier_share) best = a;
    best.iterations = iterations;
  }
  return best;
}

}  // namespace helicoid
