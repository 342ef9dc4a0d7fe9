// Random graphs of relations for tests: nothing about them is special.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>
#include <vector>

#include "helicoid/base/random.hpp"
#include "helicoid/fit/fit_graph.hpp"

namespace helicoid {

inline Pose2 random_pose(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-3, 3)};
}

/// A full, anisotropic information of some centimetres and degrees.
inline Matrix3d random_information(Random& random) {
  Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i) = random.normal();
  return 100 * (root * root.transpose() + 0.1 * Matrix3d::Identity());
}

/// A chain of poses about a metre apart and `closures` relations between any two, all measured with noise; starts are
/// `off` from the truth.
inline RelationGraph random_graph(std::uint64_t seed, std::uint32_t poses, std::uint32_t closures, double off = 0.1) {
  Random random(seed);
  RelationGraph graph;
  std::vector<Pose2> truth(1);
  for (std::uint32_t i = 1; i < poses; ++i) {
    truth.push_back(truth.back() * Pose2{1, 0.1 * random.normal(), 0.4 * random.normal()});
  }
  const auto relate = [&](std::uint32_t a, std::uint32_t b) {
    const Pose2 noise{0.02 * random.normal(), 0.02 * random.normal(), 0.01 * random.normal()};
    graph.relations.push_back(
        {a, b, PosePose{truth[a].inverse() * truth[b] * noise, random_information(random)}, b != a + 1});
  };
  for (std::uint32_t i = 1; i < poses; ++i) relate(i - 1, i);
  for (std::uint32_t k = 0; k < closures; ++k) {
    const auto a = static_cast<std::uint32_t>(random.below(poses));
    const auto b = static_cast<std::uint32_t>(random.below(poses));
    if (a != b) relate(a, b);
  }
  for (const Pose2& T : truth) {
    graph.poses.push_back(T * Pose2{off * random.normal(), off * random.normal(), off * random.normal()});
  }
  graph.poses[0] = truth[0];
  return graph;
}

/// A graph of pair forms, relation by relation, measured without noise.
struct FormGraph {
  std::vector<Pose2> poses;
  std::deque<PairForm> forms;
  std::vector<GraphEdge> edges;

  void relate(std::uint32_t a, std::uint32_t b, const Matrix3d& information, double scale = 1) {
    forms.push_back(pose_pose_form(poses[a].inverse() * poses[b], information));
    edges.push_back({a, b, &forms.back(), scale});
  }
};

/// The largest of all differences of coordinates, in metres and radians, pose by pose.
inline double largest_difference(std::span<const Pose2> a, std::span<const Pose2> b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Pose2 d = a[i].inverse() * b[i];
    most = std::max({most, std::abs(d.x), std::abs(d.y), std::abs(d.yaw)});
  }
  return most;
}

}  // namespace helicoid
