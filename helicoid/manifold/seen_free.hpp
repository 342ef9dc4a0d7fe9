// What a patch saw as free, asked for many points: for judging whether two views agree.
#pragma once

#include "helicoid/manifold/patch.hpp"
#include "helicoid/sensor/beam_finder.hpp"

namespace helicoid {

class SeenFree {
 public:
  /// The patch outlives this.
  explicit SeenFree(const Patch& patch);

  /// True if the point (patch frame, metres) lies in the patch's free space, at least `depth` metres before its edge
  /// along the beam that looks there and along its neighbours: a point behind an edge is not inside.
  [[nodiscard]] bool is_deep(const Eigen::Vector2f& p_patch, float depth) const;

  /// True if the beam that looks there, or one beside it, ended this near the point: what was there is there still.
  [[nodiscard]] bool ends_at(const Eigen::Vector2f& p_patch, float within) const;

 private:
  /// The beam that looks at a point (laser frame) and has one on either side; below 0: none.
  [[nodiscard]] std::ptrdiff_t beam_at(const Eigen::Vector2f& p_laser) const;

  const std::vector<float>& ranges_;
  const std::vector<float>& measured_;
  BeamFinder beams_;
  Eigen::Matrix2f R_laser_patch_;
  Eigen::Vector2f t_laser_patch_;
};

/// The same, asked in another frame.
class SeenFreeFrom {
 public:
  SeenFreeFrom(const Patch& patch, const Pose2& T_patch_asked)
      : free_(patch),
        R_patch_asked_(T_patch_asked.rotation().cast<float>()),
        t_patch_asked_(T_patch_asked.translation().cast<float>()) {}

  [[nodiscard]] bool is_deep(const Eigen::Vector2f& p_asked, float depth) const {
    return free_.is_deep(R_patch_asked_ * p_asked + t_patch_asked_, depth);
  }
  [[nodiscard]] bool ends_at(const Eigen::Vector2f& p_asked, float within) const {
    return free_.ends_at(R_patch_asked_ * p_asked + t_patch_asked_, within);
  }

 private:
  SeenFree free_;
  Eigen::Matrix2f R_patch_asked_;
  Eigen::Vector2f t_patch_asked_;
};

/// How many of the points (with a normal, of another view) lie that deep in what the patch saw as free.
[[nodiscard]] int count_contradictions(const Patch& patch, const ScanPoints& points, const Pose2& T_patch_points,
                                       double depth);
/// The same of two patches, either's points in what the other saw as free.
[[nodiscard]] int count_contradictions(const Patch& a, const Patch& b, const Pose2& T_a_b, double depth);

/// The same, that deep across the surfaces on which the points lie: where one view looks along a wall, what the wall is
/// off by is many times as much along the beams.
[[nodiscard]] int count_contradictions_across(const Patch& a, const Patch& b, const Pose2& T_a_b, double depth);

}  // namespace helicoid
