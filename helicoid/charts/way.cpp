#include "helicoid/charts/way.hpp"

#include "helicoid/charts/simplify.hpp"

namespace helicoid {

std::vector<Way> ways_over(const Map& map, std::span<const PatchId> patches, double tolerance) {
  std::vector<char> shown(map.patch_count(), 0);
  for (const PatchId id : patches) shown[id.index()] = 1;
  std::vector<Way> ways;
  for (std::size_t i = 0; i < map.robots().size(); ++i) {
    const RobotRecord& robot = map.robots()[i];
    Way way{make_id<RobotId>(i), robot.name, {}};
    std::vector<Vector2d> line;
    const auto finish = [&] {
      if (line.size() > 1) way.lines.push_back(charts::simplify(line, tolerance));
      line.clear();
    };
    for (const TrackedScan& scan : robot.trajectory) {
      if (shown[scan.pose.patch.index()] == 0) {
        finish();
        continue;
      }
      line.push_back(map.T_plane_patch(scan.pose.patch) * scan.pose.T_patch_robot.translation());
    }
    finish();
    if (!way.lines.empty()) ways.push_back(std::move(way));
  }
  return ways;
}

}  // namespace helicoid
