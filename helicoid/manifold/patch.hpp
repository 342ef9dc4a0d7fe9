// A patch (eq. 1): a free-space polygon and what a scan saw there. Its content never changes; only its pose does,
// and the pose lives in the Map.
#pragma once

#include <vector>

#include "helicoid/base/ids.hpp"
#include "helicoid/sensor/event.hpp"
#include "helicoid/sensor/laser_model.hpp"
#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

/// What a patch is made of, in the patch's frame, which is the robot's frame at that scan. Immutable and shared.
struct Patch {
  PatchId id;
  RobotId robot;
  std::size_t scan_index = 0;  ///< which of its robot's scans, counted from 0
  double stamp = 0;            ///< seconds
  Scan scan;                   ///< as it was measured: everything below follows from it and the laser
  LaserModel laser;

  std::vector<Eigen::Vector2f> free_space;  ///< the polygon s: open ring, anticlockwise; see sensor/free_space.hpp
  std::vector<float> free_ranges;           ///< the polygon's radii, beam by beam, about the laser
  ScanPoints points;
  double free_reach = 0;  ///< largest distance of the polygon from the patch's origin, metres
  double reach = 0;       ///< largest distance of the polygon or of a point from the patch's origin, metres
};

/// Derives all that follows from a scan. The same scan and laser give the same patch, to the bit.
[[nodiscard]] Patch make_patch(PatchId id, RobotId robot, std::size_t scan_index, double stamp, Scan scan,
                               const LaserModel& laser);
/// The same with the tables of the laser at hand.
[[nodiscard]] Patch make_patch(PatchId id, RobotId robot, std::size_t scan_index, double stamp, Scan scan,
                               ScanPointExtractor& extractor);

/// True if p_patch lies in the free-space polygon; O(1) by its star shape.
[[nodiscard]] bool contains(const Patch& patch, const Vector2d& p_patch);

/// True if p_patch is a place where a robot can be by this patch: in its free space, or where the body of the robot
/// that took the scan stood, which no laser sees.
[[nodiscard]] bool is_ground(const Patch& patch, const Vector2d& p_patch);

}  // namespace helicoid
