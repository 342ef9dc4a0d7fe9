// What the mapper knows between two events. Private to the mapper's own files.
#pragma once

#include "helicoid/align/align_scan.hpp"
#include "helicoid/mapping/close_loops.hpp"
#include "helicoid/mapping/island_evidence.hpp"
#include "helicoid/mapping/mapper.hpp"
#include "helicoid/mapping/reported_places.hpp"
#include "helicoid/mapping/robot_state.hpp"
#include "helicoid/mapping/sighting_log.hpp"
#include "helicoid/mapping/tie_on_sightings.hpp"

namespace helicoid {

struct Mapper::State {
  explicit State(const MapperOptions& o) : options(o), editor(map), closer(o) {}

  MapperOptions options;
  Map map;
  MapEditor editor;
  InformationGraph graph;
  LoopCloser closer;
  SightingLog sightings;
  SightingTies sighting_ties;
  ReportedPlaces reported;
  IslandProposals proposals;
  std::vector<RobotState> robots;
  MapperCounts counts;
  MapperTimes times;
  std::size_t patches_at_last_fit = 0;
  bool sighting_acted_on = false;

  void go_on_from(Map before);
  Step step(const Event& event, const Scan& scan);
  Motion advance(RobotState& robot, const Event& event, const Scan& scan);
  void follow(RobotState& robot, const Motion& motion, const PosePrior& prior, const Alignment& alignment,
              const LaserModel& laser);
  /// Where the scans tell surely where on older ground the robot stands, odometry begins anew.
  void note_known_ground(RobotState& robot, const Alignment& alignment);
  Step start_island(RobotState& robot, const Event& event, const Scan& scan);
  void renew_reference(RobotState& robot, const ScanPoints& points, const Pose2& T_anchor_robot);
  Alignment match(RobotState& robot, const ScanPoints& points, const PosePrior& prior, const Motion& motion,
                  const LaserModel& laser);
  /// Steps 2 and 3 for this scan: where it fits, `prior` that of the place from which that was found.
  Alignment find_robot(RobotState& robot, const ScanPoints& points, PosePrior& prior, const Motion& motion,
                       const LaserModel& laser);
  /// The robot taken to have stood elsewhere before this motion, known so well there. It is put back unless that
  /// explains the scan with a share of inliers above `least`; else the match.
  std::optional<Alignment> match_from(RobotState& robot, const UncertainPose2& T_last_kept_before,
                                      const ScanPoints& points, PosePrior& prior, const Motion& motion, double least,
                                      const LaserModel& laser);
  bool is_worth_keeping(RobotState& robot, const Alignment& alignment, const Scan& scan, std::size_t points) const;
  std::optional<RobotId> robot_named(const std::string& name) const;
  void take(const Event& event, const Sighting& sighting);
  void take(const Event& event, const Lookalike& alike);
  void join_what_is_determined(bool last);
  PatchId keep(RobotState& robot, const Event& event, const Scan& scan);
  void relate_to_last(RobotState& robot, PatchId id);
  void look_for_loops(PatchId id, const LocalMap& known);
  void close_what_is_left();
  void add_relation(const Relation& relation);
  /// Loop closing is set off (IV-B).
  bool compares_places() const { return options.closures && (options.look_alikes || sighting_acted_on); }
  [[nodiscard]] std::optional<LocalPatch> find_ground(const RobotState& robot) const;
  void stand_on(RobotState& robot, const LocalPatch& ground);
  const LaserModel& laser_of(RobotId robot, const Scan& scan) const { return map.robot(robot).lasers[scan.laser]; }
};

/// Eq. 11: where the robot is after this motion. What was open before it stays open: along a direction that the scans
/// leave weak, odometry's errors would else be taken for certain, scan by scan, and add up.
[[nodiscard]] PosePrior predict(const RobotState& robot, const Motion& motion);

/// CPU seconds of this thread so far.
[[nodiscard]] double thread_seconds();

}  // namespace helicoid
