#include "helicoid/manifold/content_hash.hpp"

#include <fmt/format.h>

#include <bit>

namespace helicoid {

namespace {

/// Two lanes; each step of a lane is a bijection of its state, so a single changed word always changes the hash.
class Hasher {
 public:
  void add(std::uint64_t word) {
    high_ = (high_ ^ word) * 0x9fb21c651e98df25ULL;
    high_ ^= high_ >> 29U;
    low_ = std::rotl(low_ + word * 0xc2b2ae3d27d4eb4fULL, 31) * 0x9e3779b185ebca87ULL;
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(float number) { add(std::uint64_t{std::bit_cast<std::uint32_t>(number)}); }
  void add_count(std::size_t count) { add(static_cast<std::uint64_t>(count)); }
  void add_int(int number) { add(static_cast<std::uint64_t>(static_cast<std::int64_t>(number))); }
  void add(const std::string& text) {
    add_count(text.size());
    for (const char c : text) add(std::uint64_t{static_cast<unsigned char>(c)});
  }
  void add(const Pose2& pose) {
    add(pose.x);
    add(pose.y);
    add(pose.yaw);
  }
  template <class Matrix>
  void add_matrix(const Matrix& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) add(matrix.data()[i]);
  }
  [[nodiscard]] ContentHash finish() const { return {avalanche(high_ ^ std::rotl(low_, 17)), avalanche(low_)}; }

 private:
  static std::uint64_t avalanche(std::uint64_t x) {
    x = (x ^ (x >> 33U)) * 0xff51afd7ed558ccdULL;
    x = (x ^ (x >> 33U)) * 0xc4ceb9fe1a85ec53ULL;
    return x ^ (x >> 33U);
  }
  std::uint64_t high_ = 0x243f6a8885a308d3ULL;
  std::uint64_t low_ = 0x13198a2e03707344ULL;
};

void add_laser(Hasher& hasher, const LaserModel& laser) {
  hasher.add(laser.name);
  hasher.add_int(laser.beams);
  for (const double number :
       {laser.first_bearing, laser.bearing_step, laser.max_range, laser.min_range, laser.range_sigma, laser.kappa,
        laser.incidence_bias, laser.floor_position, laser.floor_heading, laser.largest_gap, laser.scan_duration}) {
    hasher.add(number);
  }
}

void add_robot(Hasher& hasher, const RobotRecord& robot) {
  hasher.add(robot.name);
  hasher.add_count(robot.lasers.size());
  for (const LaserModel& laser : robot.lasers) add_laser(hasher, laser);
  hasher.add_count(robot.trajectory.size());
  for (const TrackedScan& scan : robot.trajectory) {
    hasher.add(scan.stamp);
    hasher.add(std::uint64_t{scan.pose.patch.value});
    hasher.add(scan.pose.T_patch_robot);
    hasher.add(scan.T_island_patch_online);
    hasher.add_matrix(scan.covariance);
  }
}

void add_patch(Hasher& hasher, const Patch& patch) {
  hasher.add(std::uint64_t{patch.id.value});
  hasher.add(std::uint64_t{patch.robot.value});
  hasher.add_count(patch.scan_index);
  hasher.add(patch.stamp);
  hasher.add_count(patch.scan.ranges.size());
  for (const float range : patch.scan.ranges) hasher.add(range);
  hasher.add(patch.scan.T_odom_robot);
  hasher.add(patch.scan.T_robot_laser);
  hasher.add_int(patch.scan.has_odometry ? 1 : 0);
  hasher.add_int(patch.scan.laser);
  add_laser(hasher, patch.laser);
}

void add_relation(Hasher& hasher, const Relation& relation) {
  hasher.add(std::uint64_t{relation.a.value});
  hasher.add(std::uint64_t{relation.b.value});
  hasher.add_int(static_cast<int>(relation.kind));
  hasher.add_matrix(relation.form.M);
  hasher.add(relation.T_a_b);
  hasher.add(relation.c_min);
  hasher.add(relation.radius);
  hasher.add_int(relation.correspondences);
}

}  // namespace

std::string ContentHash::hex() const {
  return fmt::format("{:016x}{:016x}", high, low);
}

ContentHash content_hash(const Map& map) {
  Hasher hasher;
  hasher.add_count(map.robots().size());
  for (const RobotRecord& robot : map.robots()) add_robot(hasher, robot);
  hasher.add_count(map.island_count());
  hasher.add_count(map.patch_count());
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const auto id = make_id<PatchId>(i);
    add_patch(hasher, map.patch(id));
    hasher.add(map.T_plane_patch(id));
    hasher.add(std::uint64_t{map.island_of(id).value});
  }
  hasher.add_count(map.relations().size());
  for (const Relation& relation : map.relations()) add_relation(hasher, relation);
  return hasher.finish();
}

}  // namespace helicoid
