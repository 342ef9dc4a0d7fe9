#include "helicoid/manifold/trajectory.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

namespace helicoid {

namespace {

/// What is computed again from what was read must round to the same code.
constexpr double kRounding = 1e-6;
constexpr double kSmallestDeviation = 1e-5;  ///< metres or radians; code 1. Code 0 is zero itself.
constexpr double kDeviationStep = 1.0625;    ///< up to 47 m at code 255
constexpr int kCorrelations = 15;            ///< steps of a correlation to either side of none
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

/// Of (x, y), (x, yaw) and (y, yaw), in steps.
using Correlations = std::array<int, 3>;

/// Of a matrix with ones on its diagonal.
bool is_positive(const Correlations& steps) {
  constexpr double kStep = 1.0 / kCorrelations;
  const double a = steps[0] * kStep;
  const double b = steps[1] * kStep;
  const double c = steps[2] * kStep;
  return 1 + 2 * a * b * c - a * a - b * b - c * c >= 0;
}

std::uint16_t pack(const Correlations& steps) {
  unsigned bits = 0;
  for (const int step : steps) bits = bits << 5U | static_cast<unsigned>(step + kCorrelations);
  return static_cast<std::uint16_t>(bits);
}

double unpack(std::uint16_t bits, int which) {
  const int step = static_cast<int>(bits >> static_cast<unsigned>(5 * (2 - which)) & 31U) - kCorrelations;
  return static_cast<double>(step) / kCorrelations;
}

std::array<std::uint8_t, 3> three_bytes(std::uint32_t lower) {
  return {static_cast<std::uint8_t>(lower), static_cast<std::uint8_t>(lower >> 8U),
          static_cast<std::uint8_t>(lower >> 16U)};
}

std::uint32_t whole(const std::array<std::uint8_t, 3>& bytes) {
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8U | static_cast<std::uint32_t>(bytes[2]) << 16U;
}

std::array<std::uint8_t, 3> short_float(double value) {
  // Rounds to the nearest: the next larger magnitude is the next larger number, across exponents too.
  return three_bytes((std::bit_cast<std::uint32_t>(static_cast<float>(value)) + 0x80U) >> 8U);
}

double long_float(const std::array<std::uint8_t, 3>& bytes) {
  return static_cast<double>(std::bit_cast<float>(whole(bytes) << 8U));
}

/// Of what begins at scans, in order: that which scan i belongs to.
template <class List>
auto last_before(const List& list, std::size_t i) {
  return std::prev(std::upper_bound(list.begin(), list.end(), i,
                                    [](std::size_t at, const auto& element) { return at < element.first; }));
}

}  // namespace

void Trajectory::put_covariance(Place& place, const Matrix3d& covariance) {
  for (int k = 0; k < 3; ++k) place.deviations[static_cast<std::size_t>(k)] = deviation_code(covariance(k, k));
  static constexpr int kRow[] = {0, 0, 1};
  static constexpr int kColumn[] = {1, 2, 2};
  // Rounded correlations may contradict one another: then all of them fade, which claims less.
  Correlations steps{};
  for (int share = kCorrelations; share >= 0; --share) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double scale = std::sqrt(covariance(kRow[k], kRow[k]) * covariance(kColumn[k], kColumn[k]));
      const double correlation = scale > 0 ? covariance(kRow[k], kColumn[k]) / scale : 0;
      const double code = share * std::clamp(correlation, -1.0, 1.0);
      steps[k] = static_cast<int>(code + std::copysign(kRounding, code));
    }
    if (is_positive(steps)) break;
  }
  place.correlations = pack(steps);
}

Matrix3d Trajectory::covariance_of(const Place& place) {
  Matrix3d covariance = Matrix3d::Identity();
  covariance(0, 1) = covariance(1, 0) = unpack(place.correlations, 0);
  covariance(0, 2) = covariance(2, 0) = unpack(place.correlations, 1);
  covariance(1, 2) = covariance(2, 1) = unpack(place.correlations, 2);
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
  constexpr double kLongest = 1 << 24;  // microseconds: three bytes
  double since = clocks_.empty() ? -1 : 1e6 * (scan.stamp - clocks_.back().stamp);
  // Stamps may step back.
  if (!(since >= 0 && since < kLongest - 1)) {
    clocks_.push_back({static_cast<std::uint32_t>(size_), scan.stamp});
    since = 0;
  }
  const std::uint32_t ground = ground_of(scan);
  if (stretches_.empty() || stretches_.back().ground != ground) {
    stretches_.push_back({static_cast<std::uint32_t>(size_), ground});
  }
  if (size_++ % kBlock == 0) blocks_.emplace_back().reserve(kBlock);
  const Pose2& T = scan.pose.T_patch_robot;
  Place& place = blocks_.back().emplace_back();
  place.x = short_float(T.x);
  place.y = short_float(T.y);
  place.microseconds = three_bytes(static_cast<std::uint32_t>(std::llround(since)));
  place.yaw = static_cast<std::uint16_t>(std::llround(wrap_angle(T.yaw) * kHeadings));
  put_covariance(place, scan.covariance);
}

TrackedScan Trajectory::read(std::size_t stretch, std::size_t i) const {
  const Stretch& on = stretches_[stretch];
  const Ground& ground = grounds_[on.ground];
  const Place& place = blocks_[i / kBlock][i % kBlock];
  const auto yaw = static_cast<std::int16_t>(place.yaw);
  return {stamp(i),
          {ground.patch, {long_float(place.x), long_float(place.y), yaw / kHeadings}},
          ground.T_island_patch,
          covariance_of(place)};
}

double Trajectory::stamp(std::size_t i) const {
  return last_before(clocks_, i)->stamp + 1e-6 * whole(blocks_[i / kBlock][i % kBlock].microseconds);
}

std::size_t Trajectory::last_not_after(double stamp) const {
  std::size_t end = size_;
  for (auto clock = clocks_.rbegin(); clock != clocks_.rend(); ++clock) {
    // No scan of a clock is before it: all of one that began later are passed over at once.
    for (std::size_t i = end; clock->stamp <= stamp && i-- > clock->first;) {
      if (clock->stamp + 1e-6 * whole(blocks_[i / kBlock][i % kBlock].microseconds) <= stamp) return i;
    }
    end = clock->first;
  }
  return size_;
}

TrackedScan Trajectory::operator[](std::size_t i) const {
  return read(static_cast<std::size_t>(last_before(stretches_, i) - stretches_.begin()), i);
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
         latest_ground_.capacity() * sizeof(std::uint32_t) + clocks_.capacity() * sizeof(Clock);
}

}  // namespace helicoid
