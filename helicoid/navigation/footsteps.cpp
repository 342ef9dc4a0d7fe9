#include "helicoid/navigation/footsteps.hpp"

namespace helicoid {

namespace {

constexpr double kStep = 0.10;  // metres

}  // namespace

bool Footsteps::follows(const Map& map) const {
  if (map.robots().size() < readers_.size()) return false;
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    const Reader& reader = readers_[i];
    if (reader.scans == 0) continue;
    const Trajectory& trajectory = map.robots()[i].trajectory;
    if (trajectory.size() < reader.scans) return false;
    const TrackedScan last = trajectory[reader.scans - 1];
    if (last.stamp != reader.last.stamp || last.pose != reader.last.pose) return false;
  }
  return true;
}

void Footsteps::read(const Map& map) {
  if (!follows(map)) *this = {};
  readers_.resize(map.robots().size());
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    Reader& reader = readers_[i];
    const Trajectory& trajectory = map.robots()[i].trajectory;
    for (; reader.scans < trajectory.size(); ++reader.scans) {
      reader.last = trajectory[reader.scans];
      const Vector2d p_plane = map.project(reader.last.pose).translation();
      const bool moved = !reader.patch.valid() ||
                         map.island_of(reader.patch) != map.island_of(reader.last.pose.patch) ||
                         (p_plane - reader.p_plane).norm() >= kStep;
      if (!moved) continue;
      reader.p_plane = p_plane;
      reader.patch = reader.last.pose.patch;
      points_.push_back(point_of(reader.last.pose));
    }
  }
}

}  // namespace helicoid
