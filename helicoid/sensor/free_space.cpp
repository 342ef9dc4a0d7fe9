#include "helicoid/sensor/free_space.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

std::vector<float> free_ranges(const Scan& scan, const LaserModel& laser) {
  // Beyond this range two beams are so far apart that an obstacle can stand between them unseen.
  const auto reach = static_cast<float>(std::min(laser.max_range, laser.largest_gap / laser.bearing_step));
  std::vector<float> measured(static_cast<std::size_t>(laser.beams), 0);
  const std::size_t beams = std::min(scan.ranges.size(), measured.size());
  for (std::size_t i = 0; i < beams; ++i) {
    const float range = scan.ranges[i];
    if (is_return(range, laser)) {
      measured[i] = std::min(range, reach);
    } else if (range >= static_cast<float>(laser.max_range)) {
      // No return: a dark or grazing surface swallows beams too, so it vouches for no more than its neighbours do;
      // see below. NaN and ranges below the minimum vouch for nothing.
      measured[i] = -1;
    }
  }
  std::vector<float> free = measured;
  for (std::size_t i = 0; i < beams; ++i) {
    if (measured[i] >= 0) continue;
    // A run of no-returns reaches as far as the farther of the returns at its ends, and no farther than `reach`.
    std::size_t first = i;
    while (first > 0 && measured[first - 1] < 0) --first;
    std::size_t last = i;
    while (last + 1 < beams && measured[last + 1] < 0) ++last;
    const float before = first > 0 ? measured[first - 1] : 0;
    const float after = last + 1 < beams ? measured[last + 1] : 0;
    free[i] = std::min(before, after);
  }
  return free;
}

std::vector<Eigen::Vector2f> free_space_polygon(const Scan& scan, const LaserModel& laser, const BeamTable& table) {
  const std::vector<float> radii = free_ranges(scan, laser);
  std::vector<Eigen::Vector2f> ring;
  const auto c = static_cast<float>(std::cos(scan.T_robot_laser.yaw));
  const auto s = static_cast<float>(std::sin(scan.T_robot_laser.yaw));
  const Eigen::Vector2f centre = scan.T_robot_laser.translation().cast<float>();
  const bool whole_turn = laser.field_of_view() + laser.bearing_step > 2 * std::numbers::pi - 1e-3;
  if (!whole_turn) ring.push_back(centre);
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
