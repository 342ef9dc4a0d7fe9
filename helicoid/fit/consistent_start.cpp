#include "helicoid/fit/consistent_start.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "helicoid/fit/cpu_clock.hpp"
#include "helicoid/fit/linear_system.hpp"
#include "helicoid/fit/relative_covariance.hpp"

namespace helicoid {

namespace {

/// How many relations lie between the ends of each open relation: the nearer, the better predicted.
std::vector<std::uint32_t> hops(const RelationGraph& known, const RelationGraph& graph,
                                std::span<const std::uint32_t> open) {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  for (const GraphRelation& r : known.relations) {
    if (r.a != kWorld) pairs.emplace_back(static_cast<std::int32_t>(r.a), static_cast<std::int32_t>(r.b));
  }
  const Adjacency ties = find_adjacency(static_cast<std::int32_t>(graph.poses.size()), pairs);
  std::vector<std::uint32_t> result;
  std::vector<std::uint32_t> distance(graph.poses.size());
  std::vector<std::int32_t> queue;
  for (const std::uint32_t i : open) {
    const GraphRelation& r = graph.relations[i];
    std::fill(distance.begin(), distance.end(), kWorld);
    queue.assign(1, static_cast<std::int32_t>(r.a));
    distance[r.a] = 0;
    for (std::size_t at = 0; at < queue.size() && distance[r.b] == kWorld; ++at) {
      for (const std::int32_t next : ties.of(queue[at])) {
        if (distance[next] != kWorld) continue;
        distance[next] = distance[queue[at]] + 1;
        queue.push_back(next);
      }
    }
    result.push_back(distance[r.b]);
  }
  return result;
}

/// J Sigma J^T of T_a_b at the system's last factor.
Matrix3d pair_covariance(const LinearSystem& system, std::span<const Pose2> poses, const GraphRelation& r) {
  const Eigen::Matrix<double, 3, 6> J = relative_jacobian(poses[r.a].inverse() * poses[r.b]);
  const std::uint32_t ends[2] = {r.a, r.b};
  Matrix3d covariance;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> x(kBlock * poses.size(), 0.0);
    for (int k = 0; k < 2; ++k) {
      for (int i = 0; i < 3 && !system.is_fixed(ends[k]); ++i)
        x[system.offset(ends[k]) + static_cast<std::size_t>(i)] = J(c, 3 * k + i);
    }
    system.solve(x);
    Eigen::Matrix<double, 6, 1> at;
    for (int k = 0; k < 6; ++k)
      at[k] = system.is_fixed(ends[k / 3]) ? 0 : x[system.offset(ends[k / 3]) + static_cast<std::size_t>(k % 3)];
    covariance.col(c) = J * at;
  }
  return 0.5 * (covariance + covariance.transpose());
}

/// chi^2 of the innovation of a pose-pose relation, weighed by its own and the prediction's covariance.
double innovation(const LinearSystem& system, std::span<const Pose2> poses, const GraphRelation& r) {
  const auto& m = std::get<PosePose>(r.measurement);
  const Pose2 e = m.T_a_b.inverse() * (poses[r.a].inverse() * poses[r.b]);
  Matrix3d turn = Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = m.T_a_b.rotation().transpose();
  const Matrix3d S = turn * pair_covariance(system, poses, r) * turn.transpose() + m.information.inverse();
  return e.vector().dot(S.inverse() * e.vector());
}

RelationGraph known_part(const RelationGraph& graph, const ConsistentStart& start) {
  RelationGraph known;
  known.poses = start.poses;
  known.is_landmark = graph.is_landmark;
  for (std::size_t i = 0; i < graph.relations.size(); ++i) {
    if (start.accepted[i]) known.relations.push_back(graph.relations[i]);
  }
  return known;
}

/// How much smaller chi^2 is than stated noise would make it: information is often stated with caution, and then a gate
/// as wide as stated lets wrong relations in. The median of what agreed, over that of chi^2 with 3 degrees of freedom.
double noise_scale(std::vector<double> agreed) {
  constexpr double kMedian = 2.366;
  constexpr std::size_t kEnough = 10;
  if (agreed.size() < kEnough) return 1;
  const auto middle = agreed.begin() + static_cast<std::ptrdiff_t>(agreed.size() / 2);
  std::nth_element(agreed.begin(), middle, agreed.end());
  constexpr double kCaution = 4;  // nearest ones agree best
  return std::clamp(kCaution * *middle / kMedian, 1e-3, 1.0);
}

}  // namespace

ConsistentStart consistent_start(const RelationGraph& graph, std::span<const std::uint32_t> fixed,
                                 const FitOptions& options) {
  ConsistentStart start{graph.poses, std::vector<bool>(graph.relations.size(), true), true, 0};
  const CpuTimer timer(start.cpu_s);
  std::vector<std::uint32_t> open;
  for (std::uint32_t i = 0; i < graph.relations.size(); ++i) {
    if (!graph.relations[i].may_be_wrong) continue;
    start.accepted[i] = false;
    if (std::holds_alternative<PosePose>(graph.relations[i].measurement)) open.push_back(i);
  }
  FitOptions plain = options;
  plain.loss = {};
  std::vector<std::uint32_t> refused;
  std::vector<double> agreed;
  std::size_t total = 0;
  // Refused ones are asked again, more kindly: long chains bend further than their covariance says.
  int passes = 0;
  while (true) {
    const RelationGraph known = known_part(graph, start);
    start.poses = fit(known, fixed, plain).poses;
    if (open.empty()) {
      constexpr int kMostPasses = 6;
      if (++passes == kMostPasses) return start;
      std::swap(open, refused);
    }
    if (open.empty()) return start;
    LinearSystem system(known, fixed);
    system.linearise(start.poses);
    start.is_determined = system.factorise();
    if (!start.is_determined) return start;
    const std::vector<std::uint32_t> distance = hops(known, graph, open);
    std::vector<std::size_t> by_distance(open.size());
    std::iota(by_distance.begin(), by_distance.end(), std::size_t{0});
    std::stable_sort(by_distance.begin(), by_distance.end(),
                     [&](std::size_t l, std::size_t r) { return distance[l] < distance[r]; });
    // Some a round: what is taken in sharpens the prediction of the rest.
    by_distance.resize(std::min(open.size(), std::max<std::size_t>(30, total / 4)));
    const double gate = options.loss.width * options.loss.width * noise_scale(agreed) * std::exp2(passes);
    total += by_distance.size();
    std::vector<bool> asked(open.size(), false);
    for (const std::size_t k : by_distance) {
      asked[k] = true;
      const double chi2 = innovation(system, start.poses, graph.relations[open[k]]);
      if (chi2 > gate) {
        refused.push_back(open[k]);
        continue;
      }
      start.accepted[open[k]] = true;
      agreed.push_back(chi2);
    }
    std::vector<std::uint32_t> rest;
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (!asked[k]) rest.push_back(open[k]);
    }
    open = std::move(rest);
  }
}

}  // namespace helicoid
