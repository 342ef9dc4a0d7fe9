#include "helicoid/mapping/team_start.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/mapping/point_alignment.hpp"

namespace helicoid {

namespace {

constexpr std::uint32_t kNone = UINT32_MAX;

/// The one of these that is nearest to all others: wrong ones do not move it far.
Vector2d medoid(std::span<const Vector2d> places) {
  Vector2d best = places.front();
  double least = HUGE_VAL;
  for (const Vector2d& p : places) {
    double sum = 0;
    for (const Vector2d& q : places) sum += (p - q).norm();
    if (sum < least) least = sum, best = p;
  }
  return best;
}

class GrowingTeam {
 public:
  GrowingTeam(const TeamNodes& nodes, const TeamGraph& team, const TeamStartOptions& options)
      : nodes_(nodes), team_(team), options_(options), island_of_(nodes.count(), kNone) {
    start_.poses.resize(nodes.count());
    std::uint32_t steps = 0;
    for (std::size_t i = 0; i < nodes.robots(); ++i) {
      const std::span<const double> stamps = nodes.stamps_of(i);
      taken_.push_back(0);
      first_step_.push_back(i == 0 ? 0 : first_step_.back() + (steps == 0 ? 0 : steps - 1));
      steps = static_cast<std::uint32_t>(stamps.size());
      if (!stamps.empty()) begin_ = std::min(begin_, stamps.front()), end_ = std::max(end_, stamps.back());
    }
    by_time_.resize(team.graph.relations.size() - team.odometry);
    std::iota(by_time_.begin(), by_time_.end(), static_cast<std::uint32_t>(team.odometry));
    std::stable_sort(by_time_.begin(), by_time_.end(),
                     [this](std::uint32_t a, std::uint32_t b) { return stamp_of(a) < stamp_of(b); });
  }

  TeamStart run(const std::function<void(double)>& progress) {
    for (double until = begin_; until < end_;) {
      // A stretch without anybody is passed over.
      until = std::max(until + options_.step, std::min(next_stamp(), end_));
      take_in(until);
      fit_taken();
      if (progress) progress((until - begin_) / (end_ - begin_));
    }
    for (std::uint32_t node = nodes_.first_landmark(); node < nodes_.count(); ++node) {
      if (island_of_[node] == kNone) island_of_[node] = island_count_++;
    }
    number_islands();
    return std::move(start_);
  }

 private:
  [[nodiscard]] const GraphRelation& relation(std::uint32_t i) const { return team_.graph.relations[i]; }
  [[nodiscard]] double stamp_of_node(std::uint32_t node) const {
    const std::size_t robot = nodes_.robot_of(node);
    return nodes_.stamps_of(robot)[node - nodes_.first_of(robot)];
  }
  [[nodiscard]] double stamp_of(std::uint32_t i) const { return stamp_of_node(relation(i).a); }

  [[nodiscard]] double next_stamp() const {
    double next = HUGE_VAL;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const std::span<const double> stamps = nodes_.stamps_of(i);
      if (taken_[i] < stamps.size()) next = std::min(next, stamps[taken_[i]]);
    }
    return next;
  }

  void take_in(double until) {
    for (std::size_t i = 0; i < taken_.size(); ++i) extend(i, until);
    while (seen_ < by_time_.size() && stamp_of(by_time_[seen_]) <= until) pending_.push_back(by_time_[seen_++]);
    // A landmark that is placed, or an island that is joined, may let others be.
    while (place_landmark() || join_two(until)) {
    }
    settle_pending();
  }

  /// By dead reckoning from the robot's last pose.
  void extend(std::size_t robot, double until) {
    const std::span<const double> stamps = nodes_.stamps_of(robot);
    for (std::size_t& k = taken_[robot]; k < stamps.size() && stamps[k] <= until; ++k) {
      const std::uint32_t node = nodes_.first_of(robot) + static_cast<std::uint32_t>(k);
      if (k == 0) {
        island_of_[node] = island_count_++;
        continue;
      }
      const GraphRelation& step = relation(first_step_[robot] + static_cast<std::uint32_t>(k) - 1);
      start_.poses[node] = start_.poses[node - 1] * std::get<PosePose>(step.measurement).T_a_b;
      island_of_[node] = island_of_[node - 1];
    }
  }

  [[nodiscard]] Vector2d seen_at(std::uint32_t i) const {
    return start_.poses[relation(i).a] * std::get<PointPosition>(relation(i).measurement).p_a;
  }

  /// Places one landmark where most of those who see it agree; a single detection may be of another one.
  bool place_landmark() {
    constexpr std::size_t kWitnesses = 3;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Vector2d>> seen;  // by landmark and island
    for (const std::uint32_t i : pending_) {
      const std::uint32_t node = relation(i).b;
      if (nodes_.is_landmark(node) && island_of_[node] == kNone)
        seen[{node, island_of_[relation(i).a]}].push_back(seen_at(i));
    }
    for (const auto& [where, places] : seen) {
      if (places.size() < kWitnesses) continue;
      const Vector2d best = medoid(places);
      start_.poses[where.first] = {best.x(), best.y(), 0};
      island_of_[where.first] = where.second;
      return true;
    }
    return false;
  }

  /// Joins the two islands that have most in common, if that determines how they lie.
  bool join_two(double until) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<PointPair>> shared;
    for (const std::uint32_t i : pending_) {
      const std::uint32_t a = island_of_[relation(i).a];
      const std::uint32_t b = island_of_[relation(i).b];
      if (b == kNone || a == b || stamp_of(i) < until - options_.recent) continue;
      const Vector2d here = seen_at(i);
      const Vector2d there = start_.poses[relation(i).b].translation();
      shared[std::minmax(a, b)].push_back(a < b ? PointPair{here, there} : PointPair{there, here});
    }
    std::pair<std::uint32_t, std::uint32_t> islands;
    PointAlignment best;
    for (const auto& [pair, points] : shared) {
      const PointAlignment found = align_pairs(points);
      if (found.determined && found.agreeing > best.agreeing) best = found, islands = pair;
    }
    if (!best.determined) return false;
    for (std::uint32_t node = 0; node < nodes_.count(); ++node) {
      if (island_of_[node] != islands.second) continue;
      const bool landmark = nodes_.is_landmark(node);
      start_.poses[node] = best.T_a_b * start_.poses[node];
      if (landmark) start_.poses[node].yaw = 0;
      island_of_[node] = islands.first;
    }
    return true;
  }

  /// What lies within one island is part of its fit from now on; the rest waits.
  void settle_pending() {
    std::erase_if(pending_, [&](std::uint32_t i) {
      const bool within = island_of_[relation(i).a] == island_of_[relation(i).b];
      if (within) settled_.push_back(i);
      return within;
    });
  }

  void fit_taken();
  void number_islands();

  const TeamNodes& nodes_;
  const TeamGraph& team_;
  const TeamStartOptions& options_;
  std::vector<std::uint32_t> island_of_;
  std::uint32_t island_count_ = 0;
  std::vector<std::size_t> taken_;         ///< poses by robot
  std::vector<std::uint32_t> first_step_;  ///< of a robot's odometry
  std::vector<std::uint32_t> by_time_;     ///< detections
  std::size_t seen_ = 0;
  std::vector<std::uint32_t> pending_;  ///< detections of what is on no island yet, or on another one
  std::vector<std::uint32_t> settled_;  ///< detections within an island
  double begin_ = HUGE_VAL;
  double end_ = -HUGE_VAL;
  TeamStart start_;
};

/// All poses so far and the landmarks, with a loss that grows slowly: a wrong detection does not pull for ever.
void GrowingTeam::fit_taken() {
  RelationGraph graph;
  std::vector<std::uint32_t> node_of;
  std::vector<std::uint32_t> place(nodes_.count(), kNone);
  for (std::uint32_t node = 0; node < nodes_.count(); ++node) {
    if (island_of_[node] == kNone) continue;
    place[node] = static_cast<std::uint32_t>(node_of.size());
    node_of.push_back(node);
    graph.poses.push_back(start_.poses[node]);
    graph.is_landmark.push_back(nodes_.is_landmark(node));
  }
  const auto add = [&](std::uint32_t i) {
    const GraphRelation& r = relation(i);
    graph.relations.push_back({place[r.a], place[r.b], r.measurement, r.may_be_wrong});
  };
  for (std::uint32_t i = 0; i < team_.odometry; ++i) {
    if (place[relation(i).b] != kNone) add(i);
  }
  for (const std::uint32_t i : settled_) add(i);
  FitOptions options;
  options.max_iterations = 10;
  options.relative_tolerance = 1e-3;
  options.loss = {LossKind::cauchy, 2, 0};
  const FitResult result = fit(graph, options);
  for (std::size_t k = 0; k < node_of.size(); ++k) start_.poses[node_of[k]] = result.poses[k];
}

void GrowingTeam::number_islands() {
  std::vector<std::uint32_t> number(island_count_, kNone);
  start_.island_of.resize(nodes_.count());
  for (std::uint32_t node = 0; node < nodes_.count(); ++node) {
    std::uint32_t& n = number[island_of_[node]];
    if (n == kNone) n = start_.islands++;
    start_.island_of[node] = n;
  }
}

}  // namespace

TeamStart start_team(const TeamNodes& nodes, const TeamGraph& team, const TeamStartOptions& options,
                     const std::function<void(double)>& progress) {
  return GrowingTeam(nodes, team, options).run(progress);
}

}  // namespace helicoid
