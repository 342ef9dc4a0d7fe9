#include "helicoid/mapping/team_start.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/mapping/landmark_place.hpp"
#include "helicoid/mapping/point_alignment.hpp"

namespace helicoid {

namespace {

constexpr std::uint32_t kNone = UINT32_MAX;

/// Some of the nodes and what ties them, to be fitted alone.
class Part {
 public:
  explicit Part(const TeamNodes& nodes) : nodes_(nodes), place_(nodes.count(), kNone) {}

  [[nodiscard]] bool has(std::uint32_t node) const { return place_[node] != kNone; }
  void add(std::uint32_t node, const Pose2& pose) {
    place_[node] = static_cast<std::uint32_t>(node_of_.size());
    node_of_.push_back(node);
    graph_.poses.push_back(pose);
    graph_.is_landmark.push_back(nodes_.is_landmark(node));
  }
  void add(const GraphRelation& r) {
    graph_.relations.push_back({place_[r.a], place_[r.b], r.measurement, r.may_be_wrong});
  }
  void hold(std::uint32_t node) { held_.push_back(place_[node]); }

  /// All nodes' poses, with those of this part as fitted. Where none is held the gauge is.
  [[nodiscard]] std::vector<Pose2> fitted(std::vector<Pose2> poses) const {
    FitOptions options;
    options.max_iterations = 10;
    options.relative_tolerance = 1e-3;
    options.loss = {LossKind::cauchy, 2, 0};
    const FitResult result = held_.empty() ? fit(graph_, options) : fit(graph_, held_, options);
    for (std::size_t k = 0; k < node_of_.size(); ++k) poses[node_of_[k]] = result.poses[k];
    return poses;
  }

 private:
  const TeamNodes& nodes_;
  RelationGraph graph_;
  std::vector<std::uint32_t> node_of_;
  std::vector<std::uint32_t> place_;
  std::vector<std::uint32_t> held_;
};

class GrowingTeam {
 public:
  GrowingTeam(const TeamNodes& nodes, const TeamGraph& team, const TeamStartOptions& options)
      : nodes_(nodes),
        team_(team),
        options_(options),
        island_of_(nodes.count(), kNone),
        is_fitted_(nodes.count(), false) {
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
      const bool joined = take_in(until);
      const bool due = until - begin_ >= options_.growth * fitted_whole_ || until >= end_;
      if (joined || due) {
        fit_since(-HUGE_VAL);
        fitted_whole_ = until - begin_;
      } else {
        fit_since(until - options_.recent);
      }
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

  /// Whether islands were joined.
  bool take_in(double until) {
    for (std::size_t i = 0; i < taken_.size(); ++i) extend(i, until);
    while (seen_ < by_time_.size() && stamp_of(by_time_[seen_]) <= until) pending_.push_back(by_time_[seen_++]);
    // A landmark that is placed, or an island that is joined, may let others be.
    bool joined = false;
    for (bool changed = true; changed;) {
      changed = place_landmark();
      if (!changed && join_two(until)) changed = joined = true;
    }
    settle_pending();
    return joined;
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

  void fit_since(double stamp);
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
  std::vector<bool> is_fitted_;         ///< landmarks, by node: together with all poses that saw them
  double fitted_whole_ = 0;             ///< seconds of the log that were fitted together last
  double begin_ = HUGE_VAL;
  double end_ = -HUGE_VAL;
  TeamStart start_;
};

/// The poses from this stamp on and the landmarks seen there, with a loss that grows slowly: a wrong detection does not
/// pull for ever. What older poses say of landmarks is not asked again: landmarks that were fitted with them are held,
/// and each robot's first pose.
void GrowingTeam::fit_since(double stamp) {
  const bool whole = std::isinf(stamp);
  Part part(nodes_);
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    const std::span<const double> stamps = nodes_.stamps_of(i).first(taken_[i]);
    const auto from = std::lower_bound(stamps.begin(), stamps.end(), stamp) - stamps.begin();
    for (auto k = static_cast<std::uint32_t>(from); k < stamps.size(); ++k) {
      part.add(nodes_.first_of(i) + k, start_.poses[nodes_.first_of(i) + k]);
      if (k > from) part.add(relation(first_step_[i] + k - 1));
      if (k == from && !whole) part.hold(nodes_.first_of(i) + k);
    }
  }
  for (const std::uint32_t i : settled_) {
    const GraphRelation& r = relation(i);
    if (!part.has(r.a)) continue;
    if (nodes_.is_landmark(r.b) && !part.has(r.b)) {
      part.add(r.b, start_.poses[r.b]);
      if (!whole && is_fitted_[r.b]) part.hold(r.b);
    }
    if (part.has(r.b)) part.add(r);
  }
  start_.poses = part.fitted(std::move(start_.poses));
  for (std::uint32_t node = nodes_.first_landmark(); whole && node < nodes_.count(); ++node) {
    is_fitted_[node] = part.has(node);
  }
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
