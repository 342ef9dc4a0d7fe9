// Sightings wait until the robots have been placed at their time; then each is an entry of the ledger.
#pragma once

#include <optional>
#include <vector>

#include "helicoid/mapping/loop_closer.hpp"
#include "helicoid/mapping/shared_ground.hpp"

namespace helicoid {

/// Where a robot was at the time of a sighting.
struct PlacedRobot {
  ManifoldPose pose;
  /// Of pose.T_patch_robot, in the patch's frame: what the matches left open, and what the clocks do.
  Matrix3d covariance = Matrix3d::Zero();
  /// A step to the scan before or after: somewhere on the way the robot was.
  void add_motion(const Pose2& T_before_after);
};

/// Whom a sighting may be of, placed on the manifold at its time.
struct SeenCandidate {
  RobotId robot;
  PlacedRobot at;
  SharedGround ground;  ///< what the scans say of it as long as it lies on another island
  /// The robots of either island when the sighting was compared last.
  std::vector<RobotId> observers_side, observed_side;
};

struct SightingRecord {
  RobotId observer;
  double stamp = 0;  ///< seconds, of the observer's clock
  Sighting sighting;
  PlacedRobot observer_at;                ///< valid once it is placed
  std::vector<SeenCandidate> candidates;  ///< one if it was identified
  std::size_t entry = 0;                  ///< in the ledger
  std::size_t ask_again_at = 0;           ///< how many patches there will be when the scans are asked again
  std::size_t wait = 1;                   ///< patches until then
};

class SightingLog {
 public:
  /// `observed`: the robot if it was identified, else none: then it may be of any other robot of the map.
  void add(RobotId observer, std::optional<RobotId> observed, double stamp, const Sighting& sighting);

  /// To be called after every scan: enters what can be placed now into the ledger, where the scans contradict it as
  /// rejected; asks the scans again about what they could not tell when less was mapped. `last`: no more scans will
  /// come. True if something has become known.
  bool place_waiting(const Map& map, const InformationGraph& graph, LoopCloser& closer,
                     std::span<const Decision> decisions, bool last);

  /// Those that are placed, in the order in which they were.
  [[nodiscard]] std::span<const SightingRecord> placed() const { return placed_; }
  /// Of those, by their place among them, what may still join islands: the ledger has not decided, or an operator has
  /// accepted, and a candidate was on another island at the last place_waiting(). Ascending.
  [[nodiscard]] std::span<const std::size_t> in_question() const { return in_question_; }
  /// True before the first sighting: nothing is to be done.
  [[nodiscard]] bool empty() const { return waiting_.empty() && placed_.empty(); }
  /// Sightings of robots that were not placed yet.
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Waiting {
    RobotId observer;
    std::optional<RobotId> observed;
    double stamp = 0;
    Sighting sighting;
  };
  static std::optional<SightingRecord> place(const Map& map, const Waiting& waiting, bool last);
  bool ask_again(const Map& map, const InformationGraph& graph, LoopCloser& closer, bool last);

  std::vector<Waiting> waiting_;
  std::vector<SightingRecord> placed_;
  std::vector<std::size_t> in_question_;
};

/// Where a robot was at a time, between its scans; nothing before its first scan or (unless `last`) after its last.
[[nodiscard]] std::optional<PlacedRobot> place_at(const Map& map, RobotId robot, double stamp, bool last);

/// An operator has accepted it.
[[nodiscard]] bool is_ordered(const Hypothesis& entry);

/// The ledger's words for a sighting that may be of this candidate.
[[nodiscard]] Hypothesis entry_of(const SightingRecord& record, const SeenCandidate& candidate);

}  // namespace helicoid
