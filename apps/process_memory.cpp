#include "apps/process_memory.hpp"

#include <unistd.h>

#include <fstream>

namespace helicoid {

namespace {

template <class T>
std::size_t bytes(const std::vector<T>& list) {
  return list.capacity() * sizeof(T);
}

std::size_t patch_bytes(const Patch& patch) {
  const ScanPoints& p = patch.points;
  return sizeof(Patch) + bytes(patch.scan.ranges) + bytes(patch.free_space) + bytes(patch.free_ranges) + bytes(p.x) +
         bytes(p.y) + bytes(p.nx) + bytes(p.ny) + bytes(p.weight) + bytes(p.beam);
}

}  // namespace

std::size_t map_bytes(const Map& map) {
  std::size_t total = map.relations().size_bytes() + map.poses().size_bytes();
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const auto id = make_id<PatchId>(i);
    total += patch_bytes(map.patch(id)) + map.relations_of(id).size_bytes() + sizeof(IslandId);
  }
  return total;
}

std::size_t trajectory_bytes(const Map& map) {
  std::size_t total = 0;
  for (const RobotRecord& robot : map.robots()) total += robot.trajectory.bytes();
  return total;
}

std::size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t whole = 0;
  std::size_t resident = 0;
  file >> whole >> resident;
  return file ? resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) : 0;
}

}  // namespace helicoid
