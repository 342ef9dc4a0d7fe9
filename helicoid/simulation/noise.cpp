#include "helicoid/simulation/noise.hpp"

#include <algorithm>

namespace helicoid {

LaserNoise scaled(LaserNoise noise, double factor) {
  noise.range_sigma *= factor;
  noise.missing = std::min(1.0, factor * noise.missing);
  noise.mixed = std::min(1.0, factor * noise.mixed);
  noise.range_bias_sigma *= factor;
  noise.bearing_scale_sigma *= factor;
  noise.material_sigma *= factor;
  noise.timing_sigma *= factor;
  return factor > 0 ? noise : LaserNoise::none();
}

OdometryNoise scaled(OdometryNoise noise, double factor) {
  for (double* sigma : {&noise.distance_sigma, &noise.turn_sigma, &noise.drift_sigma, &noise.distance_scale_sigma,
                        &noise.turn_scale_sigma, &noise.drift_bias_sigma, &noise.slip_per_metre}) {
    *sigma *= factor;
  }
  return noise;
}

}  // namespace helicoid
