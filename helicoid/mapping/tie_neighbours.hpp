// What is confident of one another and looks at the same ground is related (eq. 16), by the confidence that draws it on
// one sheet: the exact one. While the robots drive, a bound decides (design 5.3), and it leaves some ground untied.
#pragma once

#include "helicoid/mapping/map_in_progress.hpp"
#include "helicoid/mapping/mapper_options.hpp"

namespace helicoid {

/// Relates what is left to relate and fits, until nothing is left. `along`: how far along its robot's way each patch
/// was kept, metres.
void tie_neighbours(MapInProgress& progress, std::span<const double> along, const MapperOptions& options);

}  // namespace helicoid
