#include "helicoid/align/align_scan.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "helicoid/align/paired_points.hpp"
#include "helicoid/base/wide_lanes.hpp"

namespace helicoid {

namespace {

/// Every third beam leads the way; all of them settle the pose.
constexpr std::size_t kFirstStride = 3;

/// What one pairing says at a pose: the normal equations of eq. 13.
struct Sums {
  Matrix3d information = Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
  double squares = 0;
  double weights = 0;
  int inliers = 0;
};

constexpr std::size_t kLanes = PairedPoints::kLanes;
/// What is summed over the pairs, in lanes.
enum Summand : std::uint8_t { xx, xy, yy, xt, yt, tt, gx, gy, gt, squares, weights, inliers, kSummands };

/// The sums over the lanes.
Sums gather(const float (&lanes)[kSummands][kLanes]) {
  std::array<double, kSummands> total{};
  for (std::size_t k = 0; k < kSummands; ++k) {
    for (std::size_t l = 0; l < kLanes; ++l) total[k] += static_cast<double>(lanes[k][l]);
  }
  Sums result;
  result.information << total[xx], total[xy], total[xt], total[xy], total[yy], total[yt], total[xt], total[yt],
      total[tt];
  result.gradient << total[gx], total[gy], total[gt];
  result.squares = total[squares];
  result.weights = total[weights];
  result.inliers = static_cast<int>(total[inliers]);
  return result;
}

/// Linearises the paired residuals at T (M step, IV-A step 4). Lane by lane and then over the lanes: a fixed tree,
/// whatever the compiler makes of it.
HELICOID_WIDE_LANES
Sums sum_residuals(const PairedPoints& pairs, const Pose2& T, float robust_scale) {
  const auto c = static_cast<float>(std::cos(T.yaw));
  const auto s = static_cast<float>(std::sin(T.yaw));
  const auto tx = static_cast<float>(T.x);
  const auto ty = static_cast<float>(T.y);
  const float inverse_square_scale = 1 / (robust_scale * robust_scale);
  float sums[kSummands][kLanes] = {};
  for (std::size_t i = 0; i < pairs.size; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float lx = c * pairs.px[i + l] - s * pairs.py[i + l];
      const float ly = s * pairs.px[i + l] + c * pairs.py[i + l];
      const float nx = pairs.nx[i + l];
      const float ny = pairs.ny[i + l];
      const float r = nx * (lx + tx - pairs.qx[i + l]) + ny * (ly + ty - pairs.qy[i + l]);
      const float square = r * r;
      const float robust = 1 / (1 + square * inverse_square_scale);  // Geman-McClure
      const float w = pairs.weight[i + l] * robust * robust;
      const float jt = ny * lx - nx * ly;
      const float wx = w * nx;
      const float wy = w * ny;
      sums[xx][l] += wx * nx;
      sums[xy][l] += wx * ny;
      sums[yy][l] += wy * ny;
      sums[xt][l] += wx * jt;
      sums[yt][l] += wy * jt;
      sums[tt][l] += w * jt * jt;
      sums[gx][l] += wx * r;
      sums[gy][l] += wy * r;
      sums[gt][l] += w * jt * r;
      sums[squares][l] += w * square;
      sums[weights][l] += w;
      sums[inliers][l] += pairs.weight[i + l] > 0 && robust > 0.2F ? 1.0F : 0.0F;
    }
  }
  return gather(sums);
}

Vector3d difference(const Pose2& a, const Pose2& b) {
  return {a.x - b.x, a.y - b.y, wrap_angle(a.yaw - b.yaw)};
}

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

struct Fitted {
  Pose2 T;
  Sums sums;  ///< where they were last taken
};

/// M step (IV-A step 4, eq. 13): from T the pose that fits the pairs and the prior. `against_prior`: information of one
/// beam, correlations divided out.
Fitted fit_pairs(const PairedPoints& pairs, Pose2 T, double robust_scale, const PosePrior& prior, double against_prior,
                 double prior_freedom) {
  Sums sums;
  for (int inner = 0; inner < 2; ++inner) {
    sums = sum_residuals(pairs, T, static_cast<float>(robust_scale));
    const Vector3d off = difference(T, prior.T_reference_scan);
    // Odometry has heavy tails: a prior that the beams contradict fades (Student's t).
    const double believed = prior_freedom / (prior_freedom + off.dot(prior.information * off));
    const Matrix3d H = against_prior * sums.information + believed * prior.information;
    const Vector3d g = against_prior * sums.gradient + believed * prior.information * off;
    const Vector3d step = -(H + 1e-9 * H.trace() * Matrix3d::Identity()).ldlt().solve(g);
    T = Pose2::from_vector(T.vector() + step);
    if (step.head<2>().norm() < 5e-4 && std::abs(step[2]) < 2e-4) break;
  }
  return {T, sums};
}

/// Which points are paired and how far: few and far at first, then near, then all until they settle.
class Rounds {
 public:
  explicit Rounds(const AlignOptions& options) : options_(options), gate_(options.first_gate) {}
  [[nodiscard]] double gate() const { return gate_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }

  void begin(int iteration) {
    last_chance_ = iteration >= options_.max_iterations - 3;
    if (last_chance_) stride_ = 1;
  }
  /// True if that was the last one; `moved`: by how much the round moved the pose.
  bool end(const Vector3d& moved) {
    const bool small = moved.head<2>().norm() < 0.25 * gate_ && std::abs(moved[2]) < 0.05 * gate_;
    const bool tiny = moved.head<2>().norm() < 5e-3 && std::abs(moved[2]) < 1.5e-3;
    const bool done = stride_ == 1 && gate_ <= options_.last_gate && (++full_rounds_ >= 4 || tiny);
    if (gate_ > options_.last_gate) {
      if (small || last_chance_) gate_ = std::max(options_.last_gate, 0.4 * gate_);
    } else if (small) {
      stride_ = 1;
    }
    return done;
  }

 private:
  const AlignOptions& options_;
  double gate_;
  std::size_t stride_ = kFirstStride;
  int full_rounds_ = 0;
  bool last_chance_ = false;
};

}  // namespace

AlignOptions align_options(const LaserModel& laser) {
  AlignOptions options;
  options.kappa = laser.kappa;
  options.incidence_bias = laser.incidence_bias;
  return options;
}

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
  const auto bias_share = static_cast<float>(options.incidence_bias / options.range_sigma);
  Rounds rounds(options);
  int candidates = 0;
  Fitted fitted{prior.T_reference_scan, {}};
  for (bool done = false; !done;) {
    ++result.iterations;
    rounds.begin(result.iterations);
    const Pose2 T_paired = fitted.T;
    const PairedPoints pairs =
        pair_points(reference, scan, T_paired, static_cast<float>(rounds.gate()), rounds.stride(), bias_share);
    candidates = pairs.candidates;
    fitted = fit_pairs(pairs, T_paired, std::max(options.robust_scale, 0.33 * rounds.gate()), prior,
                       beam_information / options.kappa, options.prior_freedom);
    done = rounds.end(difference(fitted.T, T_paired));
  }
  const Sums& sums = fitted.sums;
  result.T_reference_scan = fitted.T;
  result.information = beam_information * sums.information;
  result.inlier_share = candidates > 0 ? static_cast<double>(sums.inliers) / candidates : 0;
  result.rms = sums.weights > 0 ? std::sqrt(sums.squares / sums.weights) : 0;
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
    const PairedPoints pairs = pair_points(reference, scan, T, 0.3F, 3, 0);
    starts.push_back({sum_residuals(pairs, T, 0.1F).weights, k * fan.step});
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
