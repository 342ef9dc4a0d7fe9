// Drives through a building that is known, with every scan's true pose: logs for tests of the mapper.
#pragma once

#include <cmath>
#include <vector>

#include "tests/simulated_view.hpp"

namespace helicoid::synthetic {

/// Two rooms and a corridor: 14 m by 9 m, with doors and furniture.
inline std::vector<Segment> building() {
  return {{{0, 0}, {14, 0}},  {{14, 0}, {14, 9}},     {{14, 9}, {0, 9}},      {{0, 9}, {0, 0}},
          {{0, 4}, {3, 4}},   {{4.2, 4}, {10, 4}},    {{11.2, 4}, {14, 4}},   {{7, 4}, {7, 0}},
          {{5, 7}, {5.6, 7}}, {{5.6, 7}, {5.6, 7.5}}, {{5.6, 7.5}, {5, 7.5}}, {{5, 7.5}, {5, 7}},
          {{2, 1}, {2.5, 1}}, {{2.5, 1}, {2.5, 1.6}}, {{12, 1}, {12, 1.8}}};
}

/// A corridor that leads round a block of 26 m by 16 m, with a few pillars and niches.
inline std::vector<Segment> ring() {
  return {{{0, 0}, {30, 0}},        {{30, 0}, {30, 8}},      {{30, 8}, {31, 8}},     {{31, 8}, {31, 9.5}},
          {{31, 9.5}, {30, 9.5}},   {{30, 9.5}, {30, 20}},   {{30, 20}, {12, 20}},   {{12, 20}, {12, 21}},
          {{12, 21}, {9, 21}},      {{9, 21}, {9, 20}},      {{9, 20}, {0, 20}},     {{0, 20}, {0, 0}},
          {{2, 2}, {28, 2}},        {{28, 2}, {28, 18}},     {{28, 18}, {2, 18}},    {{2, 18}, {2, 2}},
          {{6, 0}, {6, 0.5}},       {{6, 0.5}, {6.6, 0.5}},  {{6.6, 0.5}, {6.6, 0}}, {{0, 13}, {0.5, 13}},
          {{0.5, 13}, {0.5, 12.2}}, {{0.5, 12.2}, {0, 12.2}}};
}
inline std::vector<Vector2d> round_the_ring() {
  return {{1.1, 1.1}, {29, 1.1}, {29, 19}, {1.1, 19}};
}

struct Drive {
  std::vector<Event> events;
  std::vector<Pose2> truth;  ///< a scan
};

inline std::vector<Vector2d> through_all_rooms() {
  return {{1.2, 5.5},  {3.6, 5.5}, {3.6, 2}, {1.2, 2.6}, {3.6, 2},    {3.6, 5.5},  {7, 6.4},
          {10.6, 5.5}, {10.6, 2},  {9, 2},   {10.6, 2},  {10.6, 5.5}, {12.8, 7.6}, {7, 8.2}};
}

/// Laps from stop to stop with noisy odometry: a scan about every 5 cm or 4 degrees.
inline Drive drive(int laps, std::uint64_t seed, const std::vector<Vector2d>& stops = through_all_rooms(),
                   const std::vector<Segment>& segments = building()) {
  const RayCaster walls(segments);
  Random random(seed);
  Drive result;
  Pose2 T_world_robot{stops[0].x(), stops[0].y(), 0};
  Pose2 T_odom_robot{576.5, -3, 1};
  const auto move = [&](const Pose2& step) {
    T_world_robot = T_world_robot * step;
    const double noise = 0.02;
    T_odom_robot = T_odom_robot * Pose2{step.x * (1 + noise * random.normal()), noise * step.x * random.normal(),
                                        step.yaw * (1 + 2 * noise * random.normal()) + 0.1 * noise * random.normal()};
    Scan scan = look(walls, lms200(), T_world_robot);
    for (float& range : scan.ranges) range += 0.01F * static_cast<float>(random.normal());
    scan.T_odom_robot = T_odom_robot;
    result.events.push_back({make_id<RobotId>(0), 1000 + 0.2 * static_cast<double>(result.truth.size()), scan});
    result.truth.push_back(T_world_robot);
  };
  move({});
  for (std::size_t i = 0; i < stops.size() * static_cast<std::size_t>(laps); ++i) {
    const Vector2d& stop = stops[(i + 1) % stops.size()];
    const Vector2d way = T_world_robot.inverse() * stop;
    const double turn = std::atan2(way.y(), way.x());
    const int turns = static_cast<int>(std::ceil(std::abs(turn) / 0.07));
    for (int k = 0; k < turns; ++k) move({0, 0, turn / turns});
    const int steps = static_cast<int>(std::ceil(way.norm() / 0.05));
    for (int k = 0; k < steps; ++k) move({way.norm() / steps, 0, 0});
  }
  return result;
}

}  // namespace helicoid::synthetic
