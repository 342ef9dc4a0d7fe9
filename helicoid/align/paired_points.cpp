#include "helicoid/align/paired_points.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/align/open_direction.hpp"
#include "helicoid/base/wide_lanes.hpp"

namespace helicoid {

namespace {

void square_normals(PairedPoints& pairs) {
  NormalScatter scatter;
  for (std::size_t i = 0; i < pairs.size; ++i) scatter.add(pairs.nx[i], pairs.ny[i], pairs.weight[i]);
  const std::optional<Eigen::Vector2f> open = scatter.open_direction();
  if (!open) return;
  for (std::size_t i = 0; i < pairs.size; ++i) {
    const Eigen::Vector2f n = squared_to(*open, {pairs.nx[i], pairs.ny[i]});
    pairs.nx[i] = n.x();
    pairs.ny[i] = n.y();
  }
}

}  // namespace

HELICOID_WIDE_LANES
PairedPoints pair_points(const Reference& reference, const ScanPoints& scan, const Pose2& T, float gate,
                         std::size_t stride, float bias_share) {
  PairedPoints pairs;
  const auto c = static_cast<float>(std::cos(T.yaw));
  const auto s = static_cast<float>(std::sin(T.yaw));
  const auto tx = static_cast<float>(T.x);
  const auto ty = static_cast<float>(T.y);
  const std::size_t most = std::min(scan.size(), PairedPoints::kMost * stride);
  for (std::size_t i = 0; i < most; i += stride) {
    if (scan.weight[i] <= 0) continue;
    ++pairs.candidates;
    const float x = scan.x[i];
    const float y = scan.y[i];
    const float nx = c * scan.nx[i] - s * scan.ny[i];
    const float ny = s * scan.nx[i] + c * scan.ny[i];
    const int found = reference.nearest({tx + c * x - s * y, ty + s * x + c * y, nx, ny}, gate);
    if (found < 0) continue;
    const SurfaceElement e = reference.element(static_cast<std::size_t>(found));
    const float bias = bias_share * (scan.facing[i] - e.facing);
    pairs.add(x, y, e, scan.weight[i] / (1 + bias * bias));
  }
  pairs.pad();
  square_normals(pairs);
  return pairs;
}

}  // namespace helicoid
