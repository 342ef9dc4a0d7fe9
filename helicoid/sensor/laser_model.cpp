#include "helicoid/sensor/laser_model.hpp"

#include <cmath>

namespace helicoid {

BeamTable make_beam_table(const LaserModel& laser) {
  BeamTable table;
  for (int beam = 0; beam < laser.beams; ++beam) {
    table.cosine.push_back(static_cast<float>(std::cos(laser.bearing(beam))));
    table.sine.push_back(static_cast<float>(std::sin(laser.bearing(beam))));
  }
  return table;
}

}  // namespace helicoid
