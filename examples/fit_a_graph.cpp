// Three places in a row, and a fourth measurement that disagrees: where are they most likely?
#include <cstdio>
#include <vector>

#include "helicoid/fit/fit_graph.hpp"

int main() {
  using namespace helicoid;
  const Matrix3d information = Vector3d(400, 400, 3000).asDiagonal();  // 5 cm, 1 degree
  const PairForm step = pose_pose_form({1.0, 0, 0}, information);
  const PairForm across = pose_pose_form({2.1, 0, 0}, information);
  const std::vector<GraphEdge> edges = {{0, 1, &step}, {1, 2, &step}, {0, 2, &across}};
  const FitResult fit = fit_graph(std::vector<Pose2>(3), edges, 0);
  for (const Pose2& T_plane_place : fit.poses)
    std::printf("%.3f %.3f %.3f\n", T_plane_place.x, T_plane_place.y, T_plane_place.yaw);
  return fit.status == FitStatus::converged ? 0 : 1;
}
