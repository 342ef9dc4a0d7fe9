// The pair of files that ROS's map_server reads.
#pragma once

#include <string>

#include "helicoid/base/result.hpp"
#include "helicoid/charts/occupancy_grid.hpp"

namespace helicoid {

/// Writes `<stem>.pgm` (8 bit, row 0 at the top: 0 occupied, 254 free, 205 unknown) and `<stem>.yaml` (image,
/// resolution, origin of the lower left corner in the island's plane [m, m, rad], thresholds).
[[nodiscard]] Result<void> write_ros_map(const OccupancyGrid& grid, const std::string& stem);

}  // namespace helicoid
