// Small maps of known rooms for tests: noise-free scans of straight walls, with every pose known.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "helicoid/base/random.hpp"
#include "helicoid/manifold/map.hpp"
#include "helicoid/manifold/map_editor.hpp"
#include "helicoid/manifold/neighbours.hpp"

namespace helicoid::synthetic {

struct Wall {
  Vector2d from, to;  ///< plane, metres
};

/// The four walls of a rectangle.
inline std::vector<Wall> rectangle(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}}, {{x1, y0}, {x1, y1}}, {{x1, y1}, {x0, y1}}, {{x0, y1}, {x0, y0}}};
}

inline void append(std::vector<Wall>& walls, const std::vector<Wall>& more) {
  walls.insert(walls.end(), more.begin(), more.end());
}

/// A laser like the usual ones: 180 degrees ahead, one beam a degree.
inline LaserModel test_laser(int beams = 181) {
  LaserModel laser;
  laser.name = "test";
  laser.beams = beams;
  laser.first_bearing = -radians(90);
  laser.bearing_step = radians(180.0 / (beams - 1));
  laser.max_range = 30;
  return laser;
}

/// Distance along the ray from `p` in direction `d` (unit) to the nearest wall; the largest double if none.
inline double cast_ray(std::span<const Wall> walls, const Vector2d& p, const Vector2d& d) {
  double nearest = std::numeric_limits<double>::max();
  for (const Wall& wall : walls) {
    const Vector2d along = wall.to - wall.from;
    const double det = along.x() * d.y() - along.y() * d.x();
    if (std::abs(det) < 1e-12) continue;
    const Vector2d offset = wall.from - p;
    const double range = (along.x() * offset.y() - along.y() * offset.x()) / det;
    const double at = (d.x() * offset.y() - d.y() * offset.x()) / det;
    if (range > 0 && at >= 0 && at <= 1 && range < nearest) nearest = range;
  }
  return nearest;
}

inline Scan take_scan(std::span<const Wall> walls, const Pose2& T_plane_robot, const LaserModel& laser) {
  Scan scan;
  scan.T_odom_robot = T_plane_robot;
  for (int beam = 0; beam < laser.beams; ++beam) {
    const double angle = T_plane_robot.yaw + laser.bearing(beam);
    const double range = cast_ray(walls, T_plane_robot.translation(), {std::cos(angle), std::sin(angle)});
    scan.ranges.push_back(static_cast<float>(std::min(range, laser.max_range)));
  }
  return scan;
}

/// A map whose patches stand at known poses; scans follow the walls exactly. `placed` may differ from `taken`, to
/// build maps that are wrong on purpose.
struct Builder {
  Map map;
  LaserModel laser = test_laser();
  RobotId robot{};
  IslandId island{};

  explicit Builder(const std::string& name = "robot1", int beams = 181) : laser(test_laser(beams)) {
    MapEditor editor(map);
    robot = editor.add_robot(name, {laser});
    island = editor.add_island();
  }

  PatchId add(std::span<const Wall> walls, const Pose2& taken, const Pose2& placed) {
    MapEditor editor(map);
    const auto id = make_id<PatchId>(map.patch_count());
    const std::size_t index = map.robot(robot).trajectory.size();
    const double stamp = 1e9 + 0.25 * static_cast<double>(index);
    editor.add_patch(make_patch(id, robot, index, stamp, take_scan(walls, taken, laser), laser), placed, island);
    editor.append_scan(robot, {stamp, {id, {}}, placed, Matrix3d::Identity() * 1e-4});
    return id;
  }
  PatchId add(std::span<const Wall> walls, const Pose2& pose) { return add(walls, pose, pose); }

  /// `information` of x, y and yaw.
  void relate(PatchId a, PatchId b, RelationKind kind = RelationKind::overlap,
              const Vector3d& information = {1e4, 2e4, 3e4}) {
    Relation relation;
    relation.a = std::min(a, b);
    relation.b = std::max(a, b);
    relation.kind = kind;
    relation.T_a_b = map.T_plane_patch(relation.a).inverse() * map.T_plane_patch(relation.b);
    relation.form = pose_pose_form(relation.T_a_b, information.asDiagonal());
    relation.radius = 0.1;
    relation.correspondences = 57;
    MapEditor(map).add_relation(relation);
  }

  [[nodiscard]] std::vector<PatchId> patches() const {
    std::vector<PatchId> all;
    for (std::size_t i = 0; i < map.patch_count(); ++i) all.push_back(make_id<PatchId>(i));
    return all;
  }
};

/// A square room of 8 m by 6 m with the corner at the origin and a pillar of 1 m by 1 m in it, seen all round.
inline std::vector<Wall> pillar_room() {
  std::vector<Wall> walls = rectangle(0, 0, 8, 6);
  append(walls, rectangle(4, 2.5, 5, 3.5));
  return walls;
}
inline Builder pillar_map(int rounds = 1) {
  Builder builder;
  const std::vector<Wall> walls = pillar_room();
  for (int round = 0; round < rounds; ++round) {
    for (int i = 0; i < 16; ++i) {
      const double angle = radians(22.5 * i) + 0.01 * round;
      const PatchId id = builder.add(walls, {4.5 + 2.6 * std::cos(angle), 3 + 1.7 * std::sin(angle),
                                             wrap_angle(angle + radians(i % 2 == 0 ? 90 : 200))});
      if (id.value > 0) builder.relate(PatchId{id.value - 1}, id, RelationKind::chain);
    }
  }
  return builder;
}

/// All patches vouch for one another, or those do that were made less than `apart` after one another.
inline Neighbours neighbours_of(const Map& map, std::size_t apart = 1000) {
  Neighbours neighbours(map.patch_count());
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    for (std::size_t j = 0; j < neighbours.size(); ++j) {
      if (i != j && std::max(i, j) - std::min(i, j) < apart) neighbours[i].push_back(make_id<PatchId>(j));
    }
  }
  return neighbours;
}

inline Pose2 random_pose(Random& random) {
  return {random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-3.1, 3.1)};
}

/// Every second has ranges to the centimetre; now and then one is NaN, infinite or minus zero.
inline Scan random_scan(Random& random, std::size_t index, const LaserModel& laser) {
  Scan scan;
  for (int beam = 0; beam < laser.beams; ++beam) {
    const bool rounded = index % 2 == 0;
    const double range = random.uniform(0.5, 12);
    scan.ranges.push_back(static_cast<float>(rounded ? std::round(range * 100) / 100 : range));
  }
  if (index % 7 == 3) scan.ranges[5] = std::numeric_limits<float>::quiet_NaN();
  if (index % 7 == 4) scan.ranges[6] = std::numeric_limits<float>::infinity();
  if (index % 7 == 5) scan.ranges[7] = -0.0F;
  scan.T_odom_robot = random_pose(random);
  scan.T_robot_laser = {-0.04, 0, -0.0};
  scan.has_odometry = index % 5 != 0;
  return scan;
}

inline Relation random_relation(Random& random, std::size_t patches) {
  Relation relation;
  const auto a = static_cast<std::uint32_t>(random.below(patches - 1));
  relation.a = PatchId{a};
  relation.b = PatchId{a + 1 + static_cast<std::uint32_t>(random.below(patches - a - 1))};
  relation.kind = static_cast<RelationKind>(random.below(5));
  Vector5d g;
  for (int k = 0; k < 5; ++k) g[k] = random.normal();
  for (int k = 0; k < 3; ++k) relation.form.add(g, random.uniform(0, 1e4));
  relation.T_a_b = random_pose(random);
  relation.c_min = random.uniform();
  relation.radius = random.uniform();
  relation.correspondences = static_cast<int>(random.below(180));
  return relation;
}

/// A map of random content, for what must survive whatever the numbers are: odd values are among them.
inline Map random_map(std::uint64_t seed, std::size_t patches, std::size_t scans, std::size_t relations) {
  Random random(seed);
  Map map;
  MapEditor editor(map);
  const LaserModel laser = test_laser(180);
  const RobotId robots[] = {editor.add_robot("north", {laser}), editor.add_robot("south", {laser, test_laser(361)})};
  const IslandId islands[] = {editor.add_island(), editor.add_island(), editor.add_island()};
  for (std::size_t i = 0; i < patches; ++i) {
    const Scan scan = random_scan(random, i, laser);
    const double stamp = 1e9 + random.uniform();
    editor.add_patch(make_patch(make_id<PatchId>(i), robots[i % 2], i, stamp, scan, laser), random_pose(random),
                     islands[i % 2 * 2]);
  }
  for (std::size_t i = 0; i < relations && patches > 1; ++i) editor.add_relation(random_relation(random, patches));
  for (std::size_t i = 0; i < scans && patches > 0; ++i) {
    const PatchId patch{static_cast<std::uint32_t>(random.below(patches))};
    const double stamp = random.uniform(0, 3e3);
    const Pose2 T_patch_robot = random_pose(random);
    TrackedScan scan{stamp, {patch, T_patch_robot}, random_pose(random), Matrix3d::Identity() * random.uniform()};
    if (i % 3 == 0) scan.covariance(0, 1) = random.uniform();
    editor.append_scan(robots[random.below(2)], scan);
  }
  return map;
}

}  // namespace helicoid::synthetic
