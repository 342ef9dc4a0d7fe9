// How well is b known relative to a? The local bound of design 5.3: the information of relations is a sum of positive
// semi-definite terms, so leaving relations out can only enlarge a covariance. What is accepted on the bound is safe.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "helicoid/geometry/covariance.hpp"

namespace helicoid {

/// For each pair of related poses the expected information of T_a_b (eq. 9), all its relations together.
class InformationGraph {
 public:
  struct Edge {
    std::uint32_t to = 0;
    Matrix3d information = Matrix3d::Zero();  ///< of T_from_to
    Matrix3d covariance = Matrix3d::Zero();
  };
  /// What is read of all edges when paths are looked for.
  struct Way {
    std::uint32_t to = 0;
    double spread = 0;  ///< a scalar size of the edge's covariance: the length by which paths are chosen
  };

  std::uint32_t add_pose();
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// Adds information about T_a_b, a != b; `T_a_b` is where it was linearised.
  void add(std::uint32_t a, std::uint32_t b, const Pose2& T_a_b, const Matrix3d& information);
  /// Forgets what was added about the pair; its place among the edges is kept for what is added next.
  void forget(std::uint32_t a, std::uint32_t b);
  [[nodiscard]] std::span<const Edge> edges(std::uint32_t pose) const { return nodes_[pose].edges; }
  /// In the edges' order.
  [[nodiscard]] std::span<const Way> ways(std::uint32_t pose) const { return nodes_[pose].ways; }

 private:
  void accumulate(std::uint32_t from, std::uint32_t to, const Matrix3d& information);
  struct Node {
    std::vector<Edge> edges;
    std::vector<Way> ways;
  };
  std::vector<Node> nodes_;
};

struct BoundOptions {
  double position = 0.15;  ///< poses are followed while their interval is below both limits; metres
  double heading = 0.06;   ///< radians
  double radius = 15;      ///< and while they lie this near in the plane; metres
  std::size_t most = 400;  ///< poses at most
  /// The noise floor of a scan, once for either end (design 5.3).
  double floor_position = 0.008;
  double floor_heading = 0.0060;
  /// Poses in doubt are found, too: those that are within so many times the limits, and of them only such as may be
  /// among so many poses that lie nearest to the reference.
  double slack = 1;
  std::size_t nearest = 0;
  /// If there are any, the search ends when all of these are found: what else there is was not asked for.
  std::span<const std::uint32_t> sought;
};

/// By what near poses are chosen, metres: one radian of heading counts as much as one.
[[nodiscard]] inline double nearness(const Pose2& T_reference_pose) {
  return T_reference_pose.translation().norm() + std::abs(T_reference_pose.yaw);
}

/// A pose within the limits and an upper bound of its covariance relative to the reference, in the reference's frame.
struct BoundedPose {
  std::uint32_t pose = 0;
  UncertainPose2 relative;
};

/// The poses that are surely confident relative to `reference` (eq. 12), the reference first, then in order of growing
/// spread. The bound is the covariance along the tree of shortest paths: the sub-graph with all other relations left
/// out. A pose that no path reaches within the limits is "unknown" and absent.
[[nodiscard]] std::vector<BoundedPose> tree_bound(const InformationGraph& graph, std::span<const Pose2> T_plane,
                                                  std::uint32_t reference, const BoundOptions& options = {});

/// The noise floor of a scan, (x, y, yaw).
[[nodiscard]] Matrix3d noise_floor(double position, double heading);
/// The covariance of T_a_b with both ends' noise floors, each counted once (design 5.3).
[[nodiscard]] Matrix3d with_noise_floor(const UncertainPose2& ab, const Matrix3d& floor_a, const Matrix3d& floor_b);

/// The covariance of all `poses` relative to poses[0] from the relations among them alone: exact for that sub-graph, a
/// bound for the whole. Dense: meant for some tens of poses. All infinite where the sub-graph leaves a pose
/// open: no limit admits them.
[[nodiscard]] std::vector<UncertainPose2> subgraph_covariance(const InformationGraph& graph,
                                                              std::span<const Pose2> T_plane,
                                                              std::span<const std::uint32_t> poses);

}  // namespace helicoid
