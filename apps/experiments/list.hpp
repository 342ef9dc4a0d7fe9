// Each experiment is made by the file of its name.
#pragma once

#include "apps/experiment.hpp"

namespace helicoid {

[[nodiscard]] Experiment buildings_experiment();
[[nodiscard]] Experiment calibration_experiment();
[[nodiscard]] Experiment campus_experiment();
[[nodiscard]] Experiment crispness_experiment();
[[nodiscard]] Experiment fig6_experiment();
[[nodiscard]] Experiment floors_experiment();
[[nodiscard]] Experiment laps_experiment();
[[nodiscard]] Experiment lies_experiment();
[[nodiscard]] Experiment mrclam_experiment();
[[nodiscard]] Experiment outliers_experiment();
[[nodiscard]] Experiment playback_experiment();
[[nodiscard]] Experiment radio_experiment();
[[nodiscard]] Experiment relations_experiment();
[[nodiscard]] Experiment rendezvous_experiment();
[[nodiscard]] Experiment retro_traverse_experiment();
[[nodiscard]] Experiment spiral_experiment();
[[nodiscard]] Experiment swarm_experiment();
[[nodiscard]] Experiment symmetry_experiment();
[[nodiscard]] Experiment team_gain_experiment();
[[nodiscard]] Experiment teams_experiment();
[[nodiscard]] Experiment undo_experiment();

}  // namespace helicoid
