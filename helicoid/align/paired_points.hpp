// A scan's points, each with the surface of a reference that it is taken to lie on (paper IV-A step 3).
#pragma once

#include <array>

#include "helicoid/align/reference.hpp"
#include "helicoid/geometry/pose2.hpp"
#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

/// Scan points with the surface elements that they were paired with; structure of arrays, padded to whole lanes with
/// pairs of weight 0.
struct PairedPoints {
  static constexpr std::size_t kLanes = 8;
  static constexpr std::size_t kMost = 2048;
  std::array<float, kMost> px, py, qx, qy, nx, ny, weight;
  std::size_t size = 0;
  int candidates = 0;

  void add(float x, float y, const SurfaceElement& e, float w) {
    px[size] = x;
    py[size] = y;
    qx[size] = e.x;
    qy[size] = e.y;
    nx[size] = e.nx;
    ny[size] = e.ny;
    weight[size++] = w;
  }
  void pad() {
    while (size % kLanes != 0) add(0, 0, {}, 0);
  }
};

/// E step (IV-A step 3): pairs every stride-th point with the nearest surface of its side within `gate` (metres), the
/// scan standing at T. Along a direction that the surfaces leave open nothing is made of their normals' errors.
/// `bias_share`: the incidence bias in standard deviations of a residual.
[[nodiscard]] PairedPoints pair_points(const Reference& reference, const ScanPoints& scan, const Pose2& T, float gate,
                                       std::size_t stride, float bias_share);

}  // namespace helicoid
