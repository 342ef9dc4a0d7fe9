// The bound along the tree of shortest paths.
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "helicoid/fit/local_bound.hpp"
#include "helicoid/fit/pose_marks.hpp"

namespace helicoid {

namespace {

struct Visit {
  double length;
  std::uint32_t pose;
  std::uint32_t from;  ///< its place among those found
  const InformationGraph::Edge* edge;
  bool operator>(const Visit& other) const {
    return length != other.length ? length > other.length : pose > other.pose;
  }
};

/// The nearest of the poses found so far: how near a pose must lie to be one of them.
class Nearest {
 public:
  explicit Nearest(std::size_t most) : most_(most) {}
  [[nodiscard]] bool has_room_for(double distance) const { return heap_.size() < most_ || distance <= heap_.front(); }
  void add(double distance) {
    if (!has_room_for(distance) || most_ == 0) return;
    if (heap_.size() == most_) {
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.pop_back();
    }
    heap_.push_back(distance);
    std::push_heap(heap_.begin(), heap_.end());
  }

 private:
  std::size_t most_;
  std::vector<double> heap_;  ///< the farthest first
};

/// The tree of shortest paths from the reference, all in the reference's frame.
class BoundTree {
 public:
  BoundTree(const InformationGraph& graph, std::span<const Pose2> T_plane, std::uint32_t reference,
            const BoundOptions& options)
      : graph_(graph),
        T_plane_(T_plane),
        options_(options),
        floor_(noise_floor(options.floor_position, options.floor_heading)),
        p_reference_(T_plane[reference].translation()),
        yaw_reference_(T_plane[reference].yaw),
        R_reference_plane_(T_plane[reference].rotation().transpose()),
        seen_at_(graph.size()),
        nearest_(options.nearest),
        is_sought_(graph.size()) {
    for (const std::uint32_t pose : options.sought) {
      if (is_sought_[pose] == PoseMarks::kNone && pose != reference) ++left_;
      is_sought_.set(pose, kSought);
    }
    found_.push_back({reference, {}});
    branches_.push_back({Matrix3d::Zero(), Matrix2d::Identity()});
    see(reference, {0, 0});
    follow_edges({0, reference, 0, nullptr});
  }

  std::vector<BoundedPose> grow() && {
    while (!heap_.empty() && found_.size() < options_.most && (options_.sought.empty() || left_ > 0)) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const Visit visit = heap_.back();
      heap_.pop_back();
      if (seen(visit.pose).place == kNotFound && reach(visit)) follow_edges(visit);
    }
    return std::move(found_);
  }

 private:
  static constexpr std::int32_t kNotFound = -1;
  static constexpr std::int32_t kTooUncertain = -2;
  static constexpr std::int32_t kSought = 0;
  /// A pose that some edge led to.
  struct Seen {
    double shortest;     ///< of the paths to it so far
    std::int32_t place;  ///< in found_
  };
  /// What is needed of a pose to go on from it.
  struct Branch {
    Matrix3d covariance;  ///< without the floors
    Matrix2d rotation;    ///< of T_reference_pose
  };

  Seen& seen(std::uint32_t pose) { return seen_[static_cast<std::size_t>(seen_at_[pose])]; }
  void see(std::uint32_t pose, const Seen& first) {
    seen_at_.set(pose, static_cast<std::int32_t>(seen_.size()));
    seen_.push_back(first);
  }

  /// Takes the pose into the tree, if it is known well enough.
  bool reach(const Visit& visit) {
    const Vector2d p = R_reference_plane_ * (T_plane_[visit.pose].translation() - p_reference_);
    BoundedPose bounded{visit.pose, {{p.x(), p.y(), wrap_angle(T_plane_[visit.pose].yaw - yaw_reference_)}, {}}};
    UncertainPose2 bare{bounded.relative.T_a_b, covariance_beyond(visit.from, p, visit.edge->covariance)};
    bounded.relative.covariance = with_noise_floor(bare, floor_, floor_);
    if (!is_wanted(bounded.relative)) {
      seen(visit.pose).place = kTooUncertain;
      return false;
    }
    seen(visit.pose).place = static_cast<std::int32_t>(found_.size());
    found_.push_back(bounded);
    branches_.push_back({bare.covariance, bounded.relative.T_a_b.rotation()});
    if (is_sought_[visit.pose] == kSought) --left_;
    return true;
  }

  bool is_wanted(const UncertainPose2& relative) {
    const ConfidenceInterval interval = confidence_interval(relative.covariance);
    const auto is_within = [&](double times) {
      return interval.position < times * options_.position && interval.heading < times * options_.heading;
    };
    if (options_.nearest == 0 || !is_within(options_.slack)) return is_within(1);
    const double distance = nearness(relative.T_a_b);
    if (!is_within(1) && !nearest_.has_room_for(distance)) return false;
    nearest_.add(distance);
    return true;
  }

  /// As compound() has it: the error of `from` acts by the lever from there to p, the edge's in its own frame.
  [[nodiscard]] Matrix3d covariance_beyond(std::size_t from, const Vector2d& p, const Matrix3d& edge) const {
    const Matrix2d& R_reference_from = branches_[from].rotation;
    Matrix3d result = branches_[from].covariance;
    const Vector2d off = p - found_[from].relative.T_a_b.translation();
    const Vector2d lever(-off.y(), off.x());
    const Vector2d by_turn = result.topRightCorner<2, 1>() + 0.5 * result(2, 2) * lever;
    result.topLeftCorner<2, 2>() += lever * by_turn.transpose() + by_turn * lever.transpose() +
                                    R_reference_from * edge.topLeftCorner<2, 2>() * R_reference_from.transpose();
    result.topRightCorner<2, 1>() += result(2, 2) * lever + R_reference_from * edge.topRightCorner<2, 1>();
    result(2, 2) += edge(2, 2);
    result(1, 0) = result(0, 1);
    result.bottomLeftCorner<1, 2>() = result.topRightCorner<2, 1>().transpose();
    return result;
  }

  void follow_edges(const Visit& visit) {
    const auto from = static_cast<std::uint32_t>(seen(visit.pose).place);
    const std::span<const InformationGraph::Way> ways = graph_.ways(visit.pose);
    const std::span<const InformationGraph::Edge> edges = graph_.edges(visit.pose);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const std::uint32_t to = ways[i].to;
      const double length = visit.length + ways[i].spread;
      const bool is_seen = seen_at_[to] != PoseMarks::kNone;
      if (is_seen && (seen(to).place != kNotFound || length >= seen(to).shortest)) continue;
      if ((T_plane_[to].translation() - p_reference_).squaredNorm() > options_.radius * options_.radius) continue;
      if (is_seen) {
        seen(to).shortest = length;
      } else {
        see(to, {length, kNotFound});
      }
      heap_.push_back({length, to, from, &edges[i]});
      std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }
  }

  const InformationGraph& graph_;
  std::span<const Pose2> T_plane_;
  const BoundOptions& options_;
  Matrix3d floor_;
  Vector2d p_reference_;
  double yaw_reference_;
  Matrix2d R_reference_plane_;
  std::vector<BoundedPose> found_;
  std::vector<Branch> branches_;  ///< by place in found_
  PoseMarks seen_at_;             ///< by pose: where in seen_
  std::vector<Seen> seen_;
  std::vector<Visit> heap_;
  Nearest nearest_;
  PoseMarks is_sought_;
  std::size_t left_ = 0;  ///< sought and not found yet
};

}  // namespace

std::vector<BoundedPose> tree_bound(const InformationGraph& graph, std::span<const Pose2> T_plane,
                                    std::uint32_t reference, const BoundOptions& options) {
  return BoundTree(graph, T_plane, reference, options).grow();
}

}  // namespace helicoid
