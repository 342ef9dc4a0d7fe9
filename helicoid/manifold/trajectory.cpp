#include "helicoid/manifold/trajectory.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace helicoid {

namespace {

/// What is computed again from what was read must round to the same code.
constexpr double kRounding = 1e-6;
constexpr double kSmallestDeviation = 1e-5;  ///< metres or radians; code 1. Code 0 is zero itself.
constexpr double kDeviationStep = 1.0625;    ///< up to 47 m at code 255
constexpr double kCorrelations = 127;
constexpr double kHeadings = 65536 / (2 * std::numbers::pi);

std::uint8_t deviation_code(double variance) {
  if (!(variance > 0)) return 0;
  const double steps = std::log(std::sqrt(variance) / kSmallestDeviation) / std::log(kDeviationStep);
  return static_cast<std::uint8_t>(std::clamp(std::ceil(steps - kRounding), 0.0, 254.0) + 1);
}

double deviation(std::uint8_t code) {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> values{};
    for (std::size_t k = 1; k < values.size(); ++k) {
      values[k] = kSmallestDeviation * std::pow(kDeviationStep, static_cast<double>(k - 1));
    }
    return values;
  }();
  return table[code];
}

/// Of a matrix with ones on its diagonal.
bool is_positive(const std::array<std::int8_t, 3>& correlations) {
  const double a = correlations[0] / kCorrelations;
  const double b = correlations[1] / kCorrelations;
  const double c = correlations[2] / kCorrelations;
  return 1 + 2 * a * b * c - a * a - b * b - c * c >= 0;
}

}  // namespace

void Trajectory::put_covariance(Place& place, const Matrix3d& covariance) {
  for (int k = 0; k < 3; ++k) place.deviations[static_cast<std::size_t>(k)] = deviation_code(covariance(k, k));
  static constexpr int kRow[] = {0, 0, 1};
  static constexpr int kColumn[] = {1, 2, 2};
  // Rounded correlations may contradict one another: then all of them fade, which claims less.
  double share = 1;
  do {
    for (std::size_t k = 0; k < 3; ++k) {
      const double scale = std::sqrt(covariance(kRow[k], kRow[k]) * covariance(kColumn[k], kColumn[k]));
      const double correlation = scale > 0 ? covariance(kRow[k], kColumn[k]) / scale : 0;
      const double code = share * kCorrelations * std::clamp(correlation, -1.0, 1.0);
      place.correlations[k] = static_cast<std::int8_t>(code + std::copysign(kRounding, code));
    }
    share -= 1 / kCorrelations;
  } while (!is_positive(place.correlations) && share > 0);
}

Matrix3d Trajectory::covariance_of(const Place& place) {
  Matrix3d covariance = Matrix3d::Identity();
  covariance(0, 1) = covariance(1, 0) = place.correlations[0] / kCorrelations;
  covariance(0, 2) = covariance(2, 0) = place.correlations[1] / kCorrelations;
  covariance(1, 2) = covariance(2, 1) = place.correlations[2] / kCorrelations;
  const Vector3d deviations(deviation(place.deviations[0]), deviation(place.deviations[1]),
                            deviation(place.deviations[2]));
  return deviations.asDiagonal() * covariance * deviations.asDiagonal();
}

std::uint32_t Trajectory::ground_of(const TrackedScan& scan) {
  assert(scan.pose.patch.valid());
  const std::size_t patch = scan.pose.patch.index();
  if (patch >= latest_ground_.size()) latest_ground_.resize(patch + 1, 0);
  std::uint32_t& latest = latest_ground_[patch];
  if (latest == 0 || grounds_[latest - 1].T_island_patch != scan.T_island_patch_online) {
    grounds_.push_back({scan.pose.patch, scan.T_island_patch_online});
    latest = static_cast<std::uint32_t>(grounds_.size());
  }
  return latest - 1;
}

void Trajectory::push_back(const TrackedScan& scan) {
  constexpr double kLongest = 4e9;
  double since = clocks_.empty() ? -1 : 1e6 * (scan.stamp - clocks_.back());
  // Stamps may step back.
  if (!(since >= 0 && since < kLongest)) {
    clocks_.push_back(scan.stamp);
    since = 0;
  }
  const std::uint32_t ground = ground_of(scan);
  const auto clock = static_cast<std::uint32_t>(clocks_.size() - 1);
  if (stretches_.empty() || stretches_.back().ground != ground || stretches_.back().clock != clock) {
    stretches_.push_back({static_cast<std::uint32_t>(size_), ground, clock});
  }
  if (size_++ % kBlock == 0) blocks_.emplace_back().reserve(kBlock);
  const Pose2& T = scan.pose.T_patch_robot;
  Place& place = blocks_.back().emplace_back();
  place.x = static_cast<float>(T.x);
  place.y = static_cast<float>(T.y);
  place.microseconds = static_cast<std::uint32_t>(std::llround(since));
  place.yaw = static_cast<std::uint16_t>(std::llround(wrap_angle(T.yaw) * kHeadings));
  put_covariance(place, scan.covariance);
}

TrackedScan Trajectory::read(std::size_t stretch, std::size_t i) const {
  const Stretch& on = stretches_[stretch];
  const Ground& ground = grounds_[on.ground];
  const Place& place = blocks_[i / kBlock][i % kBlock];
  const auto yaw = static_cast<std::int16_t>(place.yaw);
  return {clocks_[on.clock] + 1e-6 * place.microseconds,
          {ground.patch, {place.x, place.y, yaw / kHeadings}},
          ground.T_island_patch,
          covariance_of(place)};
}

TrackedScan Trajectory::operator[](std::size_t i) const {
  const auto after = std::upper_bound(stretches_.begin(), stretches_.end(), i,
                                      [](std::size_t at, const Stretch& stretch) { return at < stretch.first; });
  return read(static_cast<std::size_t>(after - stretches_.begin()) - 1, i);
}

TrackedScan Trajectory::Iterator::operator*() const {
  return trajectory_->read(stretch_, at_);
}

Trajectory::Iterator& Trajectory::Iterator::operator++() {
  ++at_;
  const std::deque<Stretch>& stretches = trajectory_->stretches_;
  if (stretch_ + 1 < stretches.size() && stretches[stretch_ + 1].first == at_) ++stretch_;
  return *this;
}

std::size_t Trajectory::bytes() const {
  return size_ * sizeof(Place) + stretches_.size() * sizeof(Stretch) + grounds_.capacity() * sizeof(Ground) +
         latest_ground_.capacity() * sizeof(std::uint32_t) + clocks_.capacity() * sizeof(double);
}

}  // namespace helicoid
