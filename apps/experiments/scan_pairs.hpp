// What two scans of a log say of one another, whatever a map or a known relation says of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/eval/relation_error.hpp"
#include "helicoid/io/robot_logs.hpp"
#include "helicoid/manifold/patch.hpp"

namespace helicoid {

/// The scans of a log's only robot, in order, each seen as a patch.
class ScanViews {
 public:
  [[nodiscard]] static Result<ScanViews> read(const std::vector<RobotLogs>& robots);
  [[nodiscard]] Patch at(std::size_t i) const {
    return make_patch(PatchId{0}, RobotId{0}, i, 0, scans_[i], lasers_[scans_[i].laser]);
  }

 private:
  std::vector<LaserModel> lasers_;
  std::vector<Scan> scans_;
};

/// What two scans say of a pose of one relative to the other.
struct Agreement {
  int correspondences = 0;
  int contradictions = 0;  ///< points of either that lie more than 15 cm within what the other saw as free
  [[nodiscard]] bool is_contradicted() const { return contradictions > correspondences; }
  /// True if it explains less than nine tenths of what the other pose explains.
  [[nodiscard]] bool is_clearly_worse_than(const Agreement& other) const {
    return correspondences < 0.9 * other.correspondences;
  }
};
[[nodiscard]] Agreement agreement(const Patch& a, const Patch& b, const Pose2& T_a_b);

/// The pose of b relative to a by their surfaces alone, from `near` on.
struct ScanMatch {
  Pose2 T_a_b;
  Pose2 halves_apart;  ///< the same by one half of b's beams, relative to that by the other half: sectors in turn
};
/// Nothing where either half of the beams leaves the pose open: it must be known to 2 cm along and across.
[[nodiscard]] std::optional<ScanMatch> match_scans(const Patch& a, const Patch& b, const Pose2& near);

/// Root mean squares over many relations: metres an axis, and degrees.
class PoseSpread {
 public:
  void add(const Pose2& off);
  [[nodiscard]] double position_m() const;
  [[nodiscard]] double heading_deg() const;
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::size_t count_ = 0;
  double square_position_ = 0, square_heading_ = 0;
};

}  // namespace helicoid
