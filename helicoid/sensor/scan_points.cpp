#include "helicoid/sensor/scan_points.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/base/wide_lanes.hpp"

namespace helicoid {

namespace {

/// Neighbours that support a normal lie within this distance of the point, or a few beams where beams lie wide.
constexpr float kSupportRadius = 0.20F;
constexpr float kSupportBeams = 2.5F;
/// Two beams in a row lie on one surface if no farther apart than this, or than a grazing wall would put them.
constexpr float kSurfaceGap = 0.12F;
constexpr float kSurfaceGapBeams = 4.0F;
constexpr std::size_t kMaxSupport = 6;
constexpr std::size_t kLeastSupport = 3;
constexpr float kMinPlanarity = 0.9F;

/// About the mean, m^2; 0 for fewer than three points.
struct SecondMoments {
  float xx = 0, xy = 0, yy = 0;
  /// Squared: 1 for points on a line, 0 for points that spread alike in all directions.
  [[nodiscard]] float flatness() const {
    const float trace = xx + yy;
    return trace > 0 ? ((xx - yy) * (xx - yy) + 4 * xy * xy) / (trace * trace) : 0;
  }
  [[nodiscard]] bool is_flat() const { return flatness() >= kMinPlanarity * kMinPlanarity; }
};

/// Of the points first..last of a list of prefixes.
SecondMoments second_moments(const std::vector<PrefixMoments>& prefix, std::size_t first, std::size_t last) {
  static constexpr double kInverse[] = {0,       1,       1.0 / 2, 1.0 / 3,  1.0 / 4,  1.0 / 5,  1.0 / 6,
                                        1.0 / 7, 1.0 / 8, 1.0 / 9, 1.0 / 10, 1.0 / 11, 1.0 / 12, 1.0 / 13};
  static_assert(std::size(kInverse) == 2 * kMaxSupport + 2);
  const std::size_t count = last + 1 - first;
  if (count < kLeastSupport) return {};
  const PrefixMoments& before = prefix[first];
  const PrefixMoments& after = prefix[last + 1];
  const double scale = kInverse[count];
  const double mean_x = (after.x - before.x) * scale;
  const double mean_y = (after.y - before.y) * scale;
  return {static_cast<float>((after.xx - before.xx) * scale - mean_x * mean_x),
          static_cast<float>((after.xy - before.xy) * scale - mean_x * mean_y),
          static_cast<float>((after.yy - before.yy) * scale - mean_y * mean_y)};
}

/// Near an edge the points about point i lie on two surfaces: its own is on one side of it, or no wider than three
/// points. Door frames and steps of a few centimetres are all that fixes a place along a corridor. first..last: the
/// points about it.
SecondMoments moments_at_edge(const std::vector<PrefixMoments>& prefix, std::size_t first, std::size_t i,
                              std::size_t last) {
  const SecondMoments before = second_moments(prefix, first, i);
  const SecondMoments after = second_moments(prefix, i, last);
  SecondMoments flattest = before.flatness() >= after.flatness() ? before : after;
  if (flattest.is_flat()) return flattest;
  for (std::size_t k = 0; k < kLeastSupport; ++k) {
    if (i < first + k || i + kLeastSupport > last + 1 + k) continue;
    const SecondMoments few = second_moments(prefix, i - k, i - k + kLeastSupport - 1);
    if (few.flatness() > flattest.flatness()) flattest = few;
  }
  return flattest;
}

}  // namespace

void ScanPoints::resize(std::size_t count) {
  x.resize(count);
  y.resize(count);
  nx.resize(count);
  ny.resize(count);
  weight.resize(count);
  facing.resize(count);
  beam.resize(count);
}

void SupportMoments::resize(std::size_t count) {
  xx.resize(count);
  xy.resize(count);
  yy.resize(count);
}

ScanPointExtractor::ScanPointExtractor(const LaserModel& laser) : laser_(laser), table_(make_beam_table(laser)) {}

const ScanPoints& ScanPointExtractor::extract(const Scan& scan) {
  const auto c = static_cast<float>(std::cos(scan.T_robot_laser.yaw));
  const auto s = static_cast<float>(std::sin(scan.T_robot_laser.yaw));
  const auto laser_x = static_cast<float>(scan.T_robot_laser.x);
  const auto laser_y = static_cast<float>(scan.T_robot_laser.y);
  const std::size_t beams = std::min(scan.ranges.size(), table_.cosine.size());
  points_.resize(beams);
  spacing_.resize(beams);
  std::size_t count = 0;
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const float range = scan.ranges[beam];
    if (!is_return(range, laser_)) continue;
    const float x = range * table_.cosine[beam];
    const float y = range * table_.sine[beam];
    points_.x[count] = laser_x + c * x - s * y;
    points_.y[count] = laser_y + s * x + c * y;
    points_.beam[count] = static_cast<std::uint16_t>(beam);
    spacing_[count++] = range * static_cast<float>(laser_.bearing_step);
  }
  points_.resize(count);
  find_support();
  find_normals(laser_x, laser_y);
  return points_;
}

void ScanPointExtractor::find_support() {
  const std::size_t count = points_.size();
  const float* x = points_.x.data();
  const float* y = points_.y.data();
  const auto square_distance = [x, y](std::size_t i, std::size_t j) {
    return (x[i] - x[j]) * (x[i] - x[j]) + (y[i] - y[j]) * (y[i] - y[j]);
  };
  prefix_.resize(count + 1);
  for (std::size_t i = 0; i < count; ++i) prefix_[i + 1] = prefix_[i].plus(x[i], y[i]);
  moments_.resize(count);
  std::size_t begin = 0;  // of the surface on which point i lies; end is one past it
  std::size_t end = 0;
  std::size_t first = 0;  // first..last support point i
  std::size_t last = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i >= end) {
      begin = i;
      for (end = i + 1; end < count; ++end) {
        const float gap = std::max(kSurfaceGap, kSurfaceGapBeams * spacing_[end]);
        if (square_distance(end - 1, end) > gap * gap) break;
      }
    }
    const float support = std::max(kSupportRadius, kSupportBeams * spacing_[i]);
    const float square = support * support;
    first = std::max({first, begin, i > kMaxSupport ? i - kMaxSupport : 0});
    while (square_distance(first, i) > square) ++first;
    last = std::max(last, i);
    while (last > i && square_distance(last, i) > square) --last;
    while (last + 1 < end && last < i + kMaxSupport && square_distance(last + 1, i) <= square) ++last;
    SecondMoments m = second_moments(prefix_, first, last);
    if (!m.is_flat()) m = moments_at_edge(prefix_, first, i, last);
    moments_.xx[i] = m.xx;
    moments_.xy[i] = m.xy;
    moments_.yy[i] = m.yy;
  }
}

HELICOID_WIDE_LANES
void ScanPointExtractor::find_normals(float laser_x, float laser_y) {
  const auto noise = static_cast<float>(laser_.range_sigma * laser_.range_sigma);
  const std::size_t count = points_.size();
  const float* __restrict x = points_.x.data();
  const float* __restrict y = points_.y.data();
  const float* __restrict xx = moments_.xx.data();
  const float* __restrict xy = moments_.xy.data();
  const float* __restrict yy = moments_.yy.data();
  float* __restrict normal_x = points_.nx.data();
  float* __restrict normal_y = points_.ny.data();
  float* __restrict facing = points_.facing.data();
  float* __restrict weight = points_.weight.data();
  for (std::size_t i = 0; i < count; ++i) {
    const float half_difference = 0.5F * (xx[i] - yy[i]);
    const float trace = xx[i] + yy[i];
    const float spread = std::sqrt(half_difference * half_difference + xy[i] * xy[i]);
    const bool is_flat = (spread > 0) & (2 * spread >= kMinPlanarity * trace);
    // The normal belongs to the smaller eigenvalue: across the direction in which the points spread.
    const float nx = half_difference > 0 ? -xy[i] : spread - half_difference;
    const float ny = half_difference > 0 ? spread + half_difference : -xy[i];
    const float to_laser_x = laser_x - x[i];
    const float to_laser_y = laser_y - y[i];
    const float towards = to_laser_x * nx + to_laser_y * ny;
    const float length = std::sqrt(nx * nx + ny * ny);
    const float unit = (towards < 0 ? -1.0F : 1.0F) / (is_flat ? length : 1.0F);
    const float distance = std::sqrt(to_laser_x * to_laser_x + to_laser_y * to_laser_y + 1e-12F);
    // What scatters more than the laser's noise is no flat surface: it counts less.
    const float scatter = 0.5F * trace - spread;
    const float excess = scatter > noise ? scatter - noise : 0.0F;
    const float cosine = towards * unit / distance;
    normal_x[i] = is_flat ? nx * unit : 0.0F;
    normal_y[i] = is_flat ? ny * unit : 0.0F;
    facing[i] = is_flat ? (cosine < 1 ? cosine : 1.0F) : 0.0F;
    weight[i] = is_flat ? noise / (noise + 0.5F * excess) : 0.0F;
  }
}

}  // namespace helicoid
