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

Surface fit_surface(const PrefixMoments& before, const PrefixMoments& after, int count) {
  const double n = count;
  const double mean_x = (after.x - before.x) / n;
  const double mean_y = (after.y - before.y) / n;
  const auto sxx = static_cast<float>((after.xx - before.xx) / n - mean_x * mean_x);
  const auto sxy = static_cast<float>((after.xy - before.xy) / n - mean_x * mean_y);
  const auto syy = static_cast<float>((after.yy - before.yy) / n - mean_y * mean_y);
  const float half_difference = 0.5F * (sxx - syy);
  const float spread = std::sqrt(half_difference * half_difference + sxy * sxy);
  const float trace = sxx + syy;
  if (spread <= 0 || 2 * spread < kMinPlanarity * trace) return {};
  // The normal belongs to the smaller eigenvalue: across the direction in which the points spread.
  const float nx = half_difference > 0 ? -sxy : spread - half_difference;
  const float ny = half_difference > 0 ? spread + half_difference : -sxy;
  const float scale = 1 / std::sqrt(nx * nx + ny * ny);
  return {nx * scale, ny * scale, std::max(0.0F, 0.5F * trace - spread), true};
}

float square_distance(const ScanPoints& points, std::size_t i, std::size_t j) {
  const float dx = points.x[i] - points.x[j];
  const float dy = points.y[i] - points.y[j];
  return dx * dx + dy * dy;
}

}  // namespace

void ScanPoints::clear() {
  x.clear();
  y.clear();
  nx.clear();
  ny.clear();
  weight.clear();
  beam.clear();
}

ScanPointExtractor::ScanPointExtractor(const LaserModel& laser) : laser_(laser), table_(make_beam_table(laser)) {}

const ScanPoints& ScanPointExtractor::extract(const Scan& scan) {
  points_.clear();
  const auto c = static_cast<float>(std::cos(scan.T_robot_laser.yaw));
  const auto s = static_cast<float>(std::sin(scan.T_robot_laser.yaw));
  const auto laser_x = static_cast<float>(scan.T_robot_laser.x);
  const auto laser_y = static_cast<float>(scan.T_robot_laser.y);
  const std::size_t beams = std::min(scan.ranges.size(), table_.cosine.size());
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const float range = scan.ranges[beam];
    if (!is_return(range, laser_)) continue;
    const float x = range * table_.cosine[beam];
    const float y = range * table_.sine[beam];
    points_.x.push_back(laser_x + c * x - s * y);
    points_.y.push_back(laser_y + s * x + c * y);
    points_.beam.push_back(static_cast<std::uint16_t>(beam));
  }
  find_normals(scan, laser_x, laser_y);
  return points_;
}

void ScanPointExtractor::find_normals(const Scan& scan, float laser_x, float laser_y) {
  const std::size_t count = points_.size();
  points_.nx.assign(count, 0);
  points_.ny.assign(count, 0);
  points_.weight.assign(count, 0);
  const auto step = static_cast<float>(laser_.bearing_step);
  const auto noise = static_cast<float>(laser_.range_sigma * laser_.range_sigma);
  std::vector<PrefixMoments>& prefix = prefix_;
  prefix.assign(1, {});
  for (std::size_t i = 0; i < count; ++i) {
    const double x = points_.x[i];
    const double y = points_.y[i];
    const PrefixMoments& p = prefix.back();
    prefix.push_back({p.x + x, p.y + y, p.xx + x * x, p.xy + x * y, p.yy + y * y});
  }
  std::size_t begin = 0;  // of the surface on which point i lies
  std::size_t first = 0;  // first..last support point i
  std::size_t last = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i >= end) {
      begin = first = last = i;
      for (end = i + 1; end < count; ++end) {
        const float spacing = scan.ranges[points_.beam[end]] * step;
        const float gap = std::max(kSurfaceGap, kSurfaceGapBeams * spacing);
        if (square_distance(points_, end - 1, end) > gap * gap) break;
      }
    }
    const float support = std::max(kSupportRadius, kSupportBeams * scan.ranges[points_.beam[i]] * step);
    const float square = support * support;
    first = std::max({first, begin, i > kMaxSupport ? i - kMaxSupport : 0});
    while (square_distance(points_, first, i) > square) ++first;
    last = std::max(last, i);
    while (last > i && square_distance(points_, last, i) > square) --last;
    while (last + 1 < end && last < i + kMaxSupport && square_distance(points_, last + 1, i) <= square) ++last;
    if (last - first < 2) continue;
    const Surface surface = fit_surface(prefix[first], prefix[last + 1], static_cast<int>(last - first + 1));
    if (!surface.flat) continue;
    const float towards = (laser_x - points_.x[i]) * surface.nx + (laser_y - points_.y[i]) * surface.ny;
    points_.nx[i] = towards < 0 ? -surface.nx : surface.nx;
    points_.ny[i] = towards < 0 ? -surface.ny : surface.ny;
    // What scatters more than the laser's noise is no flat surface: it counts less.
    points_.weight[i] = noise / (noise + 0.5F * std::max(0.0F, surface.scatter - noise));
  }
}

}  // namespace helicoid
