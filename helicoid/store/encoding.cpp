#include "helicoid/store/encoding.hpp"

#include <cmath>

namespace helicoid::store {

namespace {

enum class RangeCode : std::uint8_t { floats = 0, centimetres = 1 };

float from_centimetres(std::uint16_t centimetres) {
  return static_cast<float>(centimetres / 100.0);
}

std::optional<std::vector<std::uint16_t>> as_centimetres(const std::vector<float>& ranges) {
  std::vector<std::uint16_t> whole;
  whole.reserve(ranges.size());
  for (const float range : ranges) {
    if (!(range >= 0 && range < 655)) return {};
    const auto centimetres = static_cast<std::uint16_t>(std::lround(static_cast<double>(range) * 100));
    // Compared by bits: -0 is not 0.
    if (std::bit_cast<std::uint32_t>(from_centimetres(centimetres)) != std::bit_cast<std::uint32_t>(range)) return {};
    whole.push_back(centimetres);
  }
  return whole;
}

}  // namespace

void encode(BlobWriter& blob, const LaserModel& laser) {
  blob.put(laser.name);
  blob.put(std::int32_t{laser.beams});
  for (const double number :
       {laser.first_bearing, laser.bearing_step, laser.max_range, laser.min_range, laser.range_sigma, laser.kappa,
        laser.incidence_bias, laser.floor_position, laser.floor_heading, laser.largest_gap, laser.scan_duration}) {
    blob.put(number);
  }
}

LaserModel decode_laser(BlobReader& blob) {
  LaserModel laser;
  laser.name = blob.get_text();
  laser.beams = blob.get<std::int32_t>();
  for (double* number :
       {&laser.first_bearing, &laser.bearing_step, &laser.max_range, &laser.min_range, &laser.range_sigma, &laser.kappa,
        &laser.incidence_bias, &laser.floor_position, &laser.floor_heading, &laser.largest_gap, &laser.scan_duration}) {
    *number = blob.get<double>();
  }
  return laser;
}

void encode(BlobWriter& blob, const TrackedScan& scan) {
  blob.put(scan.stamp);
  blob.put(scan.pose.patch.value);
  blob.put(scan.pose.T_patch_robot);
  blob.put(scan.T_island_patch_online);
  blob.put_matrix(scan.covariance);
}

TrackedScan decode_tracked_scan(BlobReader& blob) {
  TrackedScan scan;
  scan.stamp = blob.get<double>();
  scan.pose.patch = PatchId{blob.get<std::uint32_t>()};
  scan.pose.T_patch_robot = blob.get_pose();
  scan.T_island_patch_online = blob.get_pose();
  scan.covariance = blob.get_matrix<Matrix3d>();
  return scan;
}

void encode(BlobWriter& blob, const Scan& scan) {
  blob.put(scan.T_odom_robot);
  blob.put(scan.T_robot_laser);
  blob.put(static_cast<std::uint8_t>(scan.has_odometry));
  blob.put(std::int32_t{scan.laser});
  blob.put(static_cast<std::uint32_t>(scan.ranges.size()));
  const auto whole = as_centimetres(scan.ranges);
  blob.put(static_cast<std::uint8_t>(whole ? RangeCode::centimetres : RangeCode::floats));
  if (whole) {
    blob.put_all(std::span<const std::uint16_t>(*whole));
  } else {
    blob.put_all(std::span<const float>(scan.ranges));
  }
}

Scan decode_scan(BlobReader& blob) {
  Scan scan;
  scan.T_odom_robot = blob.get_pose();
  scan.T_robot_laser = blob.get_pose();
  scan.has_odometry = blob.get<std::uint8_t>() != 0;
  scan.laser = blob.get<std::int32_t>();
  const auto count = blob.get<std::uint32_t>();
  const bool centimetres = blob.get<std::uint8_t>() == static_cast<std::uint8_t>(RangeCode::centimetres);
  // A wrong count must not make us ask for more memory than the blob can fill.
  const std::size_t wanted = std::size_t{count} * (centimetres ? sizeof(std::uint16_t) : sizeof(float));
  scan.ranges.reserve(std::min<std::size_t>(count, blob.left()));
  for (std::size_t i = 0; i < count && (blob.ok() && (i > 0 || wanted <= blob.left())); ++i) {
    scan.ranges.push_back(centimetres ? from_centimetres(blob.get<std::uint16_t>()) : blob.get<float>());
  }
  return scan;
}

void encode(BlobWriter& blob, const Relation& relation) {
  blob.put_matrix(relation.form.M);
  blob.put(relation.T_a_b);
  blob.put(relation.c_min);
  blob.put(relation.radius);
  blob.put(std::int32_t{relation.correspondences});
}

Relation decode_relation(BlobReader& blob) {
  Relation relation;
  relation.form.M = blob.get_matrix<Matrix5d>();
  relation.T_a_b = blob.get_pose();
  relation.c_min = blob.get<double>();
  relation.radius = blob.get<double>();
  relation.correspondences = blob.get<std::int32_t>();
  return relation;
}

}  // namespace helicoid::store
