#include "apps/experiments/scan_pairs.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "helicoid/manifold/seen_free.hpp"
#include "helicoid/mapping/relate.hpp"

namespace helicoid {

namespace {

constexpr int kSectors = 18;  // of the field of view, dealt out to two halves
constexpr int kRounds = 20;
constexpr double kKnown = 0.02;  // metres, one standard deviation
constexpr double kDeep = 0.15;   // metres

/// b with only every second sector of its beams; all of them stay in a.
Patch half_of(Patch b, int which) {
  for (std::size_t i = 0; i < b.points.size(); ++i) {
    if (b.points.beam[i] * kSectors / b.laser.beams % 2 != which) b.points.weight[i] = 0;
  }
  return b;
}

/// Matched and fitted until the pose rests.
std::optional<Pose2> fit_pair(const Patch& a, const Patch& b, Pose2 T) {
  Matrix3d information;
  for (int round = 0; round < kRounds; ++round) {
    const PairExpansion e = expand(match_patches(a, b, T).form, T);
    information = e.information / b.laser.kappa;
    const Eigen::LDLT<Matrix3d> factor(information);
    if (!(factor.vectorD().minCoeff() > 1)) return std::nullopt;
    const Vector3d step = -factor.solve(e.gradient / b.laser.kappa);
    T = Pose2::from_vector(T.vector() + step);
    if (step.norm() < 1e-5) break;
  }
  const Matrix3d covariance = information.inverse();
  if (covariance(0, 0) > kKnown * kKnown || covariance(1, 1) > kKnown * kKnown) return std::nullopt;
  return T;
}

}  // namespace

Result<ScanViews> ScanViews::read(const std::vector<RobotLogs>& robots) {
  Result<MergedLogs> logs = MergedLogs::open(robots);
  if (!logs) return tl::unexpected(logs.error());
  ScanViews views;
  while (const Event* event = logs->next()) {
    if (const auto* scan = std::get_if<Scan>(&event->body)) views.scans_.push_back(*scan);
  }
  views.lasers_ = logs->robots().front().reader->lasers();
  return views;
}

Agreement agreement(const Patch& a, const Patch& b, const Pose2& T_a_b) {
  return {match_patches(a, b, T_a_b).correspondences, count_contradictions(a, b, T_a_b, kDeep)};
}

std::optional<ScanMatch> match_scans(const Patch& a, const Patch& b, const Pose2& near) {
  const std::optional<Pose2> all = fit_pair(a, b, near);
  if (!all) return std::nullopt;
  const std::optional<Pose2> first = fit_pair(a, half_of(b, 0), *all);
  const std::optional<Pose2> second = fit_pair(a, half_of(b, 1), *all);
  if (!first || !second) return std::nullopt;
  return ScanMatch{*all, first->inverse() * *second};
}

void PoseSpread::add(const Pose2& off) {
  ++count_;
  square_position_ += 0.5 * off.translation().squaredNorm();
  square_heading_ += off.yaw * off.yaw;
}

double PoseSpread::position_m() const {
  return count_ > 0 ? std::sqrt(square_position_ / static_cast<double>(count_)) : 0;
}

double PoseSpread::heading_deg() const {
  return count_ > 0 ? degrees(std::sqrt(square_heading_ / static_cast<double>(count_))) : 0;
}

}  // namespace helicoid
