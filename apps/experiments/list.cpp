#include "apps/experiments/list.hpp"

namespace helicoid {

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> all{
      buildings_experiment(), calibration_experiment(), campus_experiment(),         crispness_experiment(),
      fig6_experiment(),      floors_experiment(),      laps_experiment(),           lies_experiment(),
      mrclam_experiment(),    outliers_experiment(),    playback_experiment(),       radio_experiment(),
      relations_experiment(), rendezvous_experiment(),  retro_traverse_experiment(), spiral_experiment(),
      swarm_experiment(),     symmetry_experiment(),    team_gain_experiment(),      teams_experiment(),
      undo_experiment()};
  return all;
}

}  // namespace helicoid
