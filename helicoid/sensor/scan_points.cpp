#include "helicoid/sensor/scan_points.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// Neighbours that support a normal lie within this distance of the point, or a few beams where beams lie wide.
constexpr float kSupportRadius = 0.20F;
constexpr float kSupportBeams = 2.5F;
/// Two beams in a row lie on one surface if no farther apart than this, or than a grazing wall would put them.
constexpr float kSurfaceGap = 0.12F;
constexpr float kSurfaceGapBeams = 4.0F;
constexpr std::size_t kMaxSupport = 6;
constexpr float kMinPlanarity = 0.9F;

/// The normal and the flatness of the points first..last about point i.
struct Surface {
  float nx = 0, ny = 0;
  float scatter = 0;  ///< mean square distance from the line, m^2
  bool flat = false;
};

Surface fit_surface(const PrefixMoments& before, const PrefixMoments& after, float count) {
  const double scale = 1 / static_cast<double>(count);
  const double mean_x = (after.x - before.x) * scale;
  const double mean_y = (after.y - before.y) * scale;
  const auto sxx = static_cast<float>((after.xx - before.xx) * scale - mean_x * mean_x);
  const auto sxy = static_cast<float>((after.xy - before.xy) * scale - mean_x * mean_y);
  const auto syy = static_cast<float>((after.yy - before.yy) * scale - mean_y * mean_y);
  const float half_difference = 0.5F * (sxx - syy);
  const float spread = std::sqrt(half_difference * half_difference + sxy * sxy);
  const float trace = sxx + syy;
  if (spread <= 0 || 2 * spread < kMinPlanarity * trace) return {};
  // The normal belongs to the smaller eigenvalue: across the direction in which the points spread.
  const float nx = half_difference > 0 ? -sxy : spread - half_difference;
  const float ny = half_difference > 0 ? spread + half_difference : -sxy;
  const float unit = 1 / std::sqrt(nx * nx + ny * ny);
  return {nx * unit, ny * unit, std::max(0.0F, 0.5F * trace - spread), true};
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
  find_normals(laser_x, laser_y);
  return points_;
}

void ScanPointExtractor::find_normals(float laser_x, float laser_y) {
  const std::size_t count = points_.size();
  const float* x = points_.x.data();
  const float* y = points_.y.data();
  const auto square_distance = [x, y](std::size_t i, std::size_t j) {
    return (x[i] - x[j]) * (x[i] - x[j]) + (y[i] - y[j]) * (y[i] - y[j]);
  };
  const auto noise = static_cast<float>(laser_.range_sigma * laser_.range_sigma);
  prefix_.resize(count + 1);
  for (std::size_t i = 0; i < count; ++i) prefix_[i + 1] = prefix_[i].plus(x[i], y[i]);
  std::size_t begin = 0;  // of the surface on which point i lies; end is one past it
  std::size_t end = 0;
  std::size_t first = 0;  // first..last support point i
  std::size_t last = 0;
  for (std::size_t i = 0; i < count; ++i) {
    points_.nx[i] = points_.ny[i] = points_.weight[i] = points_.facing[i] = 0;
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
    if (last - first < 2) continue;
    const Surface surface = fit_surface(prefix_[first], prefix_[last + 1], static_cast<float>(last - first + 1));
    if (!surface.flat) continue;
    const float to_laser_x = laser_x - x[i];
    const float to_laser_y = laser_y - y[i];
    const float towards = to_laser_x * surface.nx + to_laser_y * surface.ny;
    points_.nx[i] = towards < 0 ? -surface.nx : surface.nx;
    points_.ny[i] = towards < 0 ? -surface.ny : surface.ny;
    points_.facing[i] =
        std::min(1.0F, std::abs(towards) / std::sqrt(to_laser_x * to_laser_x + to_laser_y * to_laser_y + 1e-12F));
    // What scatters more than the laser's noise is no flat surface: it counts less.
    points_.weight[i] = noise / (noise + 0.5F * std::max(0.0F, surface.scatter - noise));
  }
}

}  // namespace helicoid
