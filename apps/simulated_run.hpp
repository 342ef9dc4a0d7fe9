// A simulated world mapped in memory: the map, and the truth of every scan beside it.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "helicoid/eval/relation_error.hpp"
#include "helicoid/mapping/mapper.hpp"
#include "helicoid/simulation/simulator.hpp"
#include "helicoid/simulation/true_relations.hpp"

namespace helicoid {

struct SimulatedRun {
  Mapper mapper;
  std::vector<TrueTrack> tracks;  ///< by robot; one pose a scan, as map().robot(id).trajectory has them
  double cpu_s = 0;               ///< thread CPU time of the mapper alone
  [[nodiscard]] const Map& map() const { return mapper.map(); }
  /// Where a patch truly stands: where its robot was when it took the patch's scan.
  [[nodiscard]] const Pose2& T_world_patch(PatchId id) const {
    const Patch& patch = map().patch(id);
    return tracks[patch.robot.index()].T_world_robot[patch.scan_index];
  }
};

/// Told of every event after the mapper's step.
using SimulationObserver = std::function<void(const SimulatedEvent&, const Step&, const Mapper&)>;

/// Asked of every event before the mapper's step: what it refuses the mapper is not told.
using SimulationFilter = std::function<bool(const SimulatedEvent&, const Mapper&)>;

/// Simulates and maps, with the laser's model from its data sheet, as for a log; finish() included. Error: a world
/// without a route.
[[nodiscard]] Result<SimulatedRun> map_simulation(const World& world, const SimulationOptions& simulation,
                                                  const MapperOptions& mapper = {},
                                                  const SimulationObserver& observer = {},
                                                  const SimulationFilter& filter = {});

/// The same in a building that changes from one day to the next: on each world in turn the robots drive their laps, and
/// start where they did the day before. Stamps and odometry go on; the noise is drawn anew. Worlds whose routes are the
/// same.
[[nodiscard]] Result<SimulatedRun> map_days(std::span<const World> days, const SimulationOptions& simulation,
                                            const MapperOptions& mapper = {}, const SimulationObserver& observer = {},
                                            const SimulationFilter& filter = {});

/// How many sheets each island has, by id.
[[nodiscard]] std::vector<int> count_sheets(const Map& map);

/// The truth of the pairs of choose_true_relations.
[[nodiscard]] std::vector<EvaluatedRelation> true_relations(std::span<const TrueTrack> tracks, std::uint64_t seed);
/// The map's final poses by robot, each in the frame of the island that its robot ended on.
[[nodiscard]] std::vector<EvaluatedTrajectory> final_trajectories(const Map& map);
/// The error of the final poses against the truth, over true_relations(..., seed).
[[nodiscard]] RelationError relation_error(const SimulatedRun& run, std::uint64_t seed,
                                           const RelationErrorOptions& options = {});

}  // namespace helicoid
