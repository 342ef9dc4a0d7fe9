#include "helicoid/sensor/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

namespace {

constexpr float kNoReturn = -1;

bool is_whole_turn(const LaserModel& laser) {
  return laser.field_of_view() + laser.bearing_step > 2 * std::numbers::pi - 1e-3;
}

/// What each beam alone says: how far it went freely, kNoReturn, or 0 for what vouches for nothing (NaN, too near).
std::vector<float> measured_ranges(const Scan& scan, const LaserModel& laser) {
  // Beyond this range two beams are so far apart that an obstacle can stand between them unseen.
  const auto reach = static_cast<float>(std::min(laser.max_range, laser.largest_gap / laser.bearing_step));
  std::vector<float> measured(static_cast<std::size_t>(laser.beams), 0);
  const std::size_t beams = std::min(scan.ranges.size(), measured.size());
  for (std::size_t i = 0; i < beams; ++i) {
    const float range = scan.ranges[i];
    if (is_return(range, laser)) {
      measured[i] = std::min(range, reach);
    } else if (range >= static_cast<float>(laser.max_range)) {
      measured[i] = kNoReturn;
    }
  }
  return measured;
}

/// A dark or grazing surface swallows beams too, so a run of no-returns vouches for no more than the nearer of the
/// beams at its ends.
void fill_no_returns(std::vector<float>& ranges) {
  for (std::size_t first = 0; first < ranges.size(); ++first) {
    if (ranges[first] != kNoReturn) continue;
    std::size_t end = first + 1;
    while (end < ranges.size() && ranges[end] == kNoReturn) ++end;
    const float before = first > 0 ? ranges[first - 1] : 0;
    const float after = end < ranges.size() ? ranges[end] : 0;
    std::fill(ranges.begin() + static_cast<std::ptrdiff_t>(first), ranges.begin() + static_cast<std::ptrdiff_t>(end),
              std::min(before, after));
    first = end - 1;
  }
}

/// Where one beam ends much nearer than the next, the laser did not see what lies between the two behind the nearer
/// end: the farther beam gives way.
std::vector<float> without_shadows(const std::vector<float>& ranges, float gap, bool whole_turn) {
  std::vector<float> seen = ranges;
  const std::size_t count = ranges.size();
  for (std::size_t i = 0; i + (whole_turn ? 0 : 1) < count; ++i) {
    const std::size_t next = i + 1 < count ? i + 1 : 0;
    if (ranges[i] <= 0 || ranges[next] <= 0) continue;
    seen[i] = std::min(seen[i], ranges[next] + gap);
    seen[next] = std::min(seen[next], ranges[i] + gap);
  }
  return seen;
}

}  // namespace

std::vector<float> free_ranges(const Scan& scan, const LaserModel& laser) {
  std::vector<float> ranges = measured_ranges(scan, laser);
  fill_no_returns(ranges);
  return without_shadows(ranges, static_cast<float>(laser.largest_gap), is_whole_turn(laser));
}

std::vector<Eigen::Vector2f> free_space_polygon(const Scan& scan, const LaserModel& laser, const BeamTable& table) {
  const std::vector<float> radii = free_ranges(scan, laser);
  std::vector<Eigen::Vector2f> ring;
  const auto c = static_cast<float>(std::cos(scan.T_robot_laser.yaw));
  const auto s = static_cast<float>(std::sin(scan.T_robot_laser.yaw));
  const Eigen::Vector2f centre = scan.T_robot_laser.translation().cast<float>();
  if (!is_whole_turn(laser)) ring.push_back(centre);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (radii[i] <= 0) {
      if (ring.empty() || ring.back() != centre) ring.push_back(centre);
      continue;
    }
    const float x = radii[i] * table.cosine[i];
    const float y = radii[i] * table.sine[i];
    ring.emplace_back(centre + Eigen::Vector2f(c * x - s * y, s * x + c * y));
  }
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) ring.clear();
  return ring;
}

}  // namespace helicoid
