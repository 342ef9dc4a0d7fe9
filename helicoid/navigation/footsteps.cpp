#include "helicoid/navigation/footsteps.hpp"

namespace helicoid {

namespace {

constexpr double kStep = 0.05;  // metres

}  // namespace

void Footsteps::read(const Map& map) {
  if (!reader_.follows(map)) *this = {};
  steps_.resize(map.robots().size());
  reader_.read_on(map, [&](std::size_t robot, const TrackedScan& scan, const TrackedScan*) {
    Step& step = steps_[robot];
    const Vector2d p_plane = map.project(scan.pose).translation();
    const bool moved = !step.patch.valid() || map.island_of(step.patch) != map.island_of(scan.pose.patch) ||
                       (p_plane - step.p_plane).norm() >= kStep;
    if (!moved) return;
    step = {scan.pose.patch, p_plane};
    points_.push_back(point_of(scan.pose));
  });
}

}  // namespace helicoid
