// The incremental step (paper IV-A) for a team of robots: events in, a manifold map out. The only writer of a Map.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "helicoid/manifold/map.hpp"
#include "helicoid/mapping/ledger.hpp"
#include "helicoid/mapping/mapper_options.hpp"
#include "helicoid/sensor/event.hpp"

namespace helicoid {

/// What became of one scan.
enum class StepStatus : std::uint8_t {
  matched,     ///< fitted against the local map
  first,       ///< the first scan of a robot: it starts an island
  predicted,   ///< not matched (too few inliers, degenerate): odometry alone says where it was taken
  not_a_scan,  ///< odometry or a sighting
};

/// What one event did.
struct Step {
  StepStatus status = StepStatus::not_a_scan;
  ManifoldPose pose;  ///< of the robot, after the step
  PatchId new_patch;  ///< valid if the scan was kept as a patch
  int iterations = 0;
  double inlier_share = 0;  ///< of the points that had a normal
};

/// Counts of what was survived or left out, shown in every summary.
struct MapperCounts {
  std::size_t scans = 0;
  std::size_t matched = 0;
  std::size_t predicted = 0;
  std::size_t empty_scans = 0;     ///< scans without a single return
  std::size_t odometry_jumps = 0;  ///< impossible steps, replaced by a constant-velocity prediction
  std::size_t scans_without_odometry = 0;
  std::size_t sightings = 0;                ///< of another robot of the team
  std::size_t sightings_without_place = 0;  ///< of a robot that was nowhere at that time
  std::size_t reported_lookalikes = 0;      ///< by another program
  std::size_t lookalikes_of_nobody = 0;     ///< with an unknown robot, or one that was nowhere at that time
  std::size_t unidentified_sightings = 0;   ///< of "?" or of a name that no robot has
  std::size_t self_sightings = 0;
  std::size_t returns_of_robots = 0;  ///< taken out of scans
  std::size_t coarse_searches = 0;    ///< restarts at a fan of headings
};

/// CPU seconds of the thread, by what they were spent on.
struct MapperTimes {
  double match_s = 0;
  double fit_s = 0;
  double close_s = 0;  ///< looking for loops and closing them, fits included
};

class Mapper {
 public:
  explicit Mapper(const MapperOptions& options = {});
  /// Goes on from a map: each of its robots stands where its last scan was taken, and has not moved since. What was
  /// open in its ledger is not known any more.
  Mapper(const MapperOptions& options, Map map);
  ~Mapper();
  Mapper(Mapper&&) noexcept;
  Mapper& operator=(Mapper&&) noexcept;

  /// Each robot starts on an island of its own. Names are unique: the caller sees to it.
  RobotId add_robot(const std::string& name, const std::vector<LaserModel>& lasers);
  /// One incremental step. The scan's ranges are copied only if it is kept as a patch.
  Step process(const Event& event);
  /// A decision that is made during the run: it holds from here on, for entries to come and for those that nobody has
  /// decided yet. What was acted on stays: taking it back is a replay.
  void decide(const Decision& decision);
  /// Where islands may lie on one another by what was mapped since the last call: entries of the ledger that wait for a
  /// decision. For teams that can go and see; finish() looks for all of them in any case.
  void propose();
  /// The last global fit, after the last event. Idempotent.
  void finish();

  /// After finish(): what was believed at once and what the finished map contradicts. The same events under these
  /// decisions besides make a map without it. `passes` over the events have been made: what merely does not fit is
  /// undone one by one at first, for one may be why another does not; then ever more at once, so that it ends.
  [[nodiscard]] std::vector<Decision> regrets(std::size_t passes = 1) const;

  /// Those that were given from the start, and during the run.
  [[nodiscard]] const std::vector<Decision>& decisions() const;

  [[nodiscard]] const Map& map() const;
  [[nodiscard]] const MapperCounts& counts() const;
  [[nodiscard]] const MapperTimes& times() const;
  /// What may be the same place, in the order in which it was found, and what was decided.
  [[nodiscard]] const Ledger& ledger() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace helicoid
