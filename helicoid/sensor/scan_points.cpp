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
constexpr int kMaxSupport = 6;
constexpr float kMinPlanarity = 0.9F;

/// First and second moments of a few points about the point that they support.
struct Moments {
  float count = 1, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  void add(float dx, float dy) {
    count += 1;
    x += dx;
    y += dy;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
};

/// Walks from point i along the beams in one direction while the surface goes on.
void gather(const ScanPoints& points, int i, int direction, float support, float gap, Moments& moments) {
  const auto size = static_cast<int>(points.size());
  const float px = points.x[i];
  const float py = points.y[i];
  float last_x = px;
  float last_y = py;
  for (int step = 1; step <= kMaxSupport; ++step) {
    const int j = i + direction * step;
    if (j < 0 || j >= size) return;
    const float x = points.x[j];
    const float y = points.y[j];
    const float gx = x - last_x;
    const float gy = y - last_y;
    const float dx = x - px;
    const float dy = y - py;
    if (gx * gx + gy * gy > gap * gap || dx * dx + dy * dy > support * support) return;
    moments.add(dx, dy);
    last_x = x;
    last_y = y;
  }
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
  const std::size_t count = points_.size();
  points_.nx.assign(count, 0);
  points_.ny.assign(count, 0);
  points_.weight.assign(count, 0);
  const auto step = static_cast<float>(laser_.bearing_step);
  const auto noise = static_cast<float>(laser_.range_sigma * laser_.range_sigma);
  for (std::size_t i = 0; i < count; ++i) {
    const float spacing = scan.ranges[points_.beam[i]] * step;
    const float support = std::max(kSupportRadius, kSupportBeams * spacing);
    const float gap = std::max(kSurfaceGap, kSurfaceGapBeams * spacing);
    Moments m;
    gather(points_, static_cast<int>(i), +1, support, gap, m);
    gather(points_, static_cast<int>(i), -1, support, gap, m);
    if (m.count < 3) continue;
    const float sxx = m.xx - m.x * m.x / m.count;
    const float sxy = m.xy - m.x * m.y / m.count;
    const float syy = m.yy - m.y * m.y / m.count;
    const float half_difference = 0.5F * (sxx - syy);
    const float spread = std::sqrt(half_difference * half_difference + sxy * sxy);
    const float trace = sxx + syy;
    const float smallest = std::max(0.0F, 0.5F * trace - spread);
    if (spread <= 0 || 2 * spread < kMinPlanarity * trace) continue;
    // The normal belongs to the smaller eigenvalue: across the direction in which the points spread.
    float nx = half_difference > 0 ? -sxy : spread - half_difference;
    float ny = half_difference > 0 ? spread + half_difference : -sxy;
    const float length = std::sqrt(nx * nx + ny * ny);
    const float towards = (laser_x - points_.x[i]) * nx + (laser_y - points_.y[i]) * ny;
    const float sign = towards < 0 ? -1 / length : 1 / length;
    points_.nx[i] = nx * sign;
    points_.ny[i] = ny * sign;
    // What scatters more than the laser's noise is no flat surface: it counts less.
    points_.weight[i] = noise / (noise + 0.5F * std::max(0.0F, smallest / m.count - noise));
  }
  return points_;
}

}  // namespace helicoid
