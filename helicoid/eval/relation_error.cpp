#include "helicoid/eval/relation_error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "helicoid/eval/stamp_lookup.hpp"

namespace helicoid {

namespace {

/// A trajectory's poses by stamp.
class PoseLookup {
 public:
  explicit PoseLookup(const EvaluatedTrajectory& trajectory) : trajectory_(&trajectory), lookup_(trajectory.stamps) {}

  [[nodiscard]] std::optional<Pose2> nearest(double stamp, double tolerance) const {
    const std::optional<std::size_t> at = lookup_.nearest(stamp, tolerance);
    return at ? std::optional(trajectory_->poses[*at]) : std::nullopt;
  }
  [[nodiscard]] const EvaluatedTrajectory& trajectory() const { return *trajectory_; }

 private:
  const EvaluatedTrajectory* trajectory_;
  StampLookup lookup_;
};

const PoseLookup* find(const std::vector<PoseLookup>& lookups, const std::string& robot) {
  if (robot.empty()) return lookups.size() == 1 ? &lookups.front() : nullptr;
  const auto at =
      std::find_if(lookups.begin(), lookups.end(), [&](const PoseLookup& l) { return l.trajectory().robot == robot; });
  return at != lookups.end() ? &*at : nullptr;
}

}  // namespace

ErrorStatistics statistics(std::span<const double> errors) {
  if (errors.empty()) return {};
  const auto count = static_cast<double>(errors.size());
  ErrorStatistics s;
  double squares = 0;
  for (const double e : errors) {
    s.mean += e / count;
    squares += e * e / count;
    s.max = std::max(s.max, e);
  }
  s.rms = std::sqrt(squares);
  s.std = std::sqrt(std::max(0.0, squares - s.mean * s.mean));
  return s;
}

RelationError relation_error(std::span<const EvaluatedTrajectory> trajectories,
                             std::span<const EvaluatedRelation> relations, const RelationErrorOptions& options) {
  const std::vector<PoseLookup> lookups(trajectories.begin(), trajectories.end());
  RelationError result;
  for (const EvaluatedRelation& relation : relations) {
    if (std::abs(relation.stamp_b - relation.stamp_a) > options.max_gap) continue;
    if (options.between_robots && relation.robot_a == relation.robot_b) continue;
    ++result.relations;
    const PoseLookup* a = find(lookups, relation.robot_a);
    const PoseLookup* b = find(lookups, relation.robot_b);
    if (a == nullptr || b == nullptr || a->trajectory().frame != b->trajectory().frame) continue;
    const auto T_plane_a = a->nearest(relation.stamp_a, options.stamp_tolerance);
    const auto T_plane_b = b->nearest(relation.stamp_b, options.stamp_tolerance);
    if (!T_plane_a || !T_plane_b) continue;
    // Kuemmerle et al. 2009, eq. 2: what is left of the measured displacement.
    const Pose2 error = relation.T_a_b.inverse() * (T_plane_a->inverse() * *T_plane_b);
    result.translations_m.push_back(error.distance());
    result.rotations_deg.push_back(std::abs(degrees(error.yaw)));
  }
  result.scored = result.translations_m.size();
  result.missing = result.relations - result.scored;
  result.translation_m = statistics(result.translations_m);
  result.rotation_deg = statistics(result.rotations_deg);
  return result;
}

}  // namespace helicoid
