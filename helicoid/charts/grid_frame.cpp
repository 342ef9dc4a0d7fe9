#include "helicoid/charts/grid_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace helicoid {

namespace {

struct Box {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::max());
  Vector2d high = Vector2d::Constant(std::numeric_limits<double>::lowest());
  void add(const Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

Box box_around(const Map& map, std::span<const PatchId> patches) {
  Box box;
  for (const PatchId id : patches) {
    const Patch& patch = map.patch(id);
    const Pose2& T_plane_patch = map.T_plane_patch(id);
    const Matrix2d R = T_plane_patch.rotation();
    const Vector2d t = T_plane_patch.translation();
    box.add(t);
    for (const auto& vertex : patch.free_space) box.add(R * vertex.cast<double>() + t);
    for (std::size_t i = 0; i < patch.points.size(); ++i) {
      box.add(R * Vector2d(patch.points.x[i], patch.points.y[i]) + t);
    }
  }
  if (patches.empty()) box.add(Vector2d::Zero());
  return box;
}

}  // namespace

GridFrame frame_around(const Map& map, std::span<const PatchId> patches, const GridFrameOptions& options) {
  const Box box = box_around(map, patches);
  for (GridFrame frame{.origin = {}, .resolution = options.resolution, .width = 0, .height = 0};;
       frame.resolution *= 2) {
    const Vector2d low = (box.low.array() - options.margin) / frame.resolution;
    const Vector2d high = (box.high.array() + options.margin) / frame.resolution;
    const Vector2d first(std::floor(low.x()), std::floor(low.y()));
    const Vector2d cells(std::floor(high.x()) - first.x() + 1, std::floor(high.y()) - first.y() + 1);
    if (cells.x() * cells.y() > static_cast<double>(options.largest_size)) continue;
    frame.origin = first * frame.resolution;
    frame.width = static_cast<int>(cells.x());
    frame.height = static_cast<int>(cells.y());
    return frame;
  }
}

}  // namespace helicoid
